#include "io/dicom/asked_for.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>

#include <algorithm>
#include <vector>

namespace palpate::io::internal {

bool is_asked_for(std::uint32_t tag) {
  static const std::vector<std::uint32_t> attributes = [] {
    std::vector<std::uint32_t> tags;
    for (const DcmTagKey& key : {DCM_SpecificCharacterSet,
                                 DCM_ImageType,
                                 DCM_SOPClassUID,
                                 DCM_SOPInstanceUID,
                                 DCM_StudyDate,
                                 DCM_AcquisitionDate,
                                 DCM_ContentDate,
                                 DCM_AcquisitionTime,
                                 DCM_ContentTime,
                                 DCM_Modality,
                                 DCM_SeriesDescription,
                                 DCM_PatientName,
                                 DCM_PatientID,
                                 DCM_SequenceName,
                                 DCM_SliceThickness,
                                 DCM_SeriesNumber,
                                 DCM_SeriesDate,
                                 DCM_SeriesTime,
                                 DCM_BodyPartExamined,
                                 DCM_ScanningSequence,
                                 DCM_ContrastBolusAgent,
                                 DCM_LossyImageCompression,
                                 DCM_LossyImageCompressionRatio,
                                 DCM_Units,
                                 DCM_ConvolutionKernel,
                                 DCM_ImageLaterality,
                                 DCM_EchoTime,
                                 DCM_SpacingBetweenSlices,
                                 DCM_TriggerTime,
                                 DCM_DiffusionBValue,
                                 DCM_DiffusionGradientOrientation,
                                 DCM_VelocityEncodingDirection,
                                 DCM_VelocityEncodingMaximumValue,
                                 DCM_StudyInstanceUID,
                                 DCM_SeriesInstanceUID,
                                 DCM_AcquisitionNumber,
                                 DCM_InstanceNumber,
                                 DCM_ImagePositionPatient,
                                 DCM_ImageOrientationPatient,
                                 DCM_FrameOfReferenceUID,
                                 DCM_TemporalPositionIdentifier,
                                 DCM_SamplesPerPixel,
                                 DCM_PhotometricInterpretation,
                                 DCM_NumberOfFrames,
                                 DCM_Rows,
                                 DCM_Columns,
                                 DCM_PixelSpacing,
                                 DCM_BitsAllocated,
                                 DCM_BitsStored,
                                 DCM_HighBit,
                                 DCM_PixelRepresentation,
                                 DCM_PixelPaddingValue,
                                 DCM_PixelPaddingRangeLimit,
                                 DCM_WindowCenter,
                                 DCM_WindowWidth,
                                 DCM_RescaleIntercept,
                                 DCM_RescaleSlope,
                                 DCM_RescaleType,
                                 DCM_ModalityLUTSequence,
                                 DCM_DirectoryRecordSequence,
                                 DCM_SharedFunctionalGroupsSequence,
                                 DCM_PerFrameFunctionalGroupsSequence}) {
      tags.push_back(std::uint32_t{key.getGroup()} << 16 | key.getElement());
    }
    // b-values of Siemens, GE and Philips, with who reserved their blocks (b_value.h).
    tags.insert(tags.end(), {0x00190010, 0x0019100C, 0x00430010, 0x00431039, 0x20010010, 0x20011003});
    std::sort(tags.begin(), tags.end());
    return tags;
  }();
  constexpr std::uint32_t siemens = 0x0029;  // its private headers
  return tag >> 16 == siemens || std::binary_search(attributes.begin(), attributes.end(), tag);
}

bool is_asked_for_of_structures(std::uint32_t tag) {
  static const std::vector<std::uint32_t> attributes = [] {
    std::vector<std::uint32_t> tags;
    for (const DcmTagKey& key : {DCM_SpecificCharacterSet,
                                 DCM_SOPClassUID,
                                 DCM_Modality,
                                 DCM_PatientID,
                                 DCM_StudyInstanceUID,
                                 DCM_FrameOfReferenceUID,
                                 DCM_NumberOfFrames,
                                 DCM_Rows,
                                 DCM_Columns,
                                 DCM_BitsAllocated,
                                 DCM_BitsStored,
                                 DCM_HighBit,
                                 DCM_TotalPixelMatrixColumns,
                                 DCM_SegmentationType,
                                 DCM_MaximumFractionalValue,
                                 DCM_SegmentSequence,
                                 DCM_SharedFunctionalGroupsSequence,
                                 DCM_PerFrameFunctionalGroupsSequence,
                                 DCM_ReferencedFrameOfReferenceSequence,
                                 DCM_StructureSetROISequence,
                                 DCM_ROIContourSequence,
                                 DCM_RTROIObservationsSequence}) {
      tags.push_back(std::uint32_t{key.getGroup()} << 16 | key.getElement());
    }
    std::sort(tags.begin(), tags.end());
    return tags;
  }();
  return std::binary_search(attributes.begin(), attributes.end(), tag);
}

}  // namespace palpate::io::internal
