#include "io/dicom/asked_for.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <vector>

namespace palpate::io::internal {

namespace {

using Tags = std::vector<std::uint32_t>;

/// Sorted.
Tags tags_of(std::initializer_list<std::span<const DcmTagKey>> groups) {
  Tags tags;
  for (const std::span<const DcmTagKey> keys : groups) {
    for (const DcmTagKey& key : keys) tags.push_back(std::uint32_t{key.getGroup()} << 16 | key.getElement());
  }
  std::sort(tags.begin(), tags.end());
  return tags;
}

bool holds(const Tags& tags, std::uint32_t tag) {
  return std::binary_search(tags.begin(), tags.end(), tag);
}

/// The patient and the scan, and the attributes that distinguish series.
const std::array of_series{
    DCM_SpecificCharacterSet, DCM_ImageType,       DCM_SOPClassUID,      DCM_SOPInstanceUID,   DCM_StudyDate,
    DCM_AcquisitionDate,      DCM_ContentDate,     DCM_AcquisitionTime,  DCM_ContentTime,      DCM_Modality,
    DCM_SeriesDescription,    DCM_PatientName,     DCM_PatientID,        DCM_SequenceName,     DCM_SeriesNumber,
    DCM_SeriesDate,           DCM_SeriesTime,      DCM_BodyPartExamined, DCM_ScanningSequence, DCM_ContrastBolusAgent,
    DCM_ConvolutionKernel,    DCM_ImageLaterality, DCM_EchoTime,         DCM_StudyInstanceUID, DCM_SeriesInstanceUID,
    DCM_AcquisitionNumber,    DCM_InstanceNumber};

/// Where and when the slices lie.
const std::array of_slices{DCM_SliceThickness,
                           DCM_SpacingBetweenSlices,
                           DCM_TriggerTime,
                           DCM_DiffusionBValue,
                           DCM_DiffusionGradientOrientation,
                           DCM_VelocityEncodingDirection,
                           DCM_VelocityEncodingMaximumValue,
                           DCM_ImagePositionPatient,
                           DCM_ImageOrientationPatient,
                           DCM_FrameOfReferenceUID,
                           DCM_TemporalPositionIdentifier,
                           DCM_NumberOfFrames,
                           DCM_PixelSpacing,
                           DCM_FrameIncrementPointer,
                           DCM_GridFrameOffsetVector,
                           DCM_DetectorInformationSequence,
                           DCM_DirectoryRecordSequence,
                           DCM_SharedFunctionalGroupsSequence,
                           DCM_PerFrameFunctionalGroupsSequence};

/// The meaning of the voxels' values.
const std::array of_values{DCM_LossyImageCompression,
                           DCM_LossyImageCompressionRatio,
                           DCM_Units,
                           DCM_SamplesPerPixel,
                           DCM_PhotometricInterpretation,
                           DCM_Rows,
                           DCM_Columns,
                           DCM_BitsAllocated,
                           DCM_BitsStored,
                           DCM_HighBit,
                           DCM_PixelRepresentation,
                           DCM_PixelPaddingValue,
                           DCM_PixelPaddingRangeLimit,
                           DCM_FloatPixelPaddingValue,
                           DCM_FloatPixelPaddingRangeLimit,
                           DCM_DoubleFloatPixelPaddingValue,
                           DCM_DoubleFloatPixelPaddingRangeLimit,
                           DCM_WindowCenter,
                           DCM_WindowWidth,
                           DCM_RescaleIntercept,
                           DCM_RescaleSlope,
                           DCM_RescaleType,
                           DCM_ModalityLUTSequence,
                           DCM_DoseGridScaling,
                           DCM_DoseUnits};

/// The b-values of Siemens, GE, UIH and Philips with the creators of their private blocks (b_value.h), and the slices
/// of UIH's grids.
const std::array of_vendors{DcmTagKey(0x0019, 0x0010), DcmTagKey(0x0019, 0x100C), DcmTagKey(0x0043, 0x0010),
                            DcmTagKey(0x0043, 0x1039), DcmTagKey(0x0065, 0x0010), DcmTagKey(0x0065, 0x1009),
                            DcmTagKey(0x0065, 0x1050), DcmTagKey(0x0065, 0x1051), DcmTagKey(0x2001, 0x0010),
                            DcmTagKey(0x2001, 0x1003)};

const std::array of_structures{DCM_SpecificCharacterSet,
                               DCM_SOPClassUID,
                               DCM_Modality,
                               DCM_PatientName,
                               DCM_PatientID,
                               DCM_StudyInstanceUID,
                               DCM_FrameOfReferenceUID,
                               DCM_NumberOfFrames,
                               DCM_Rows,
                               DCM_Columns,
                               DCM_BitsAllocated,
                               DCM_BitsStored,
                               DCM_HighBit,
                               DCM_PixelPaddingValue,
                               DCM_TotalPixelMatrixColumns,
                               DCM_SegmentationType,
                               DCM_SegmentationFractionalType,
                               DCM_MaximumFractionalValue,
                               DCM_SegmentSequence,
                               DCM_SharedFunctionalGroupsSequence,
                               DCM_PerFrameFunctionalGroupsSequence,
                               DCM_ReferencedFrameOfReferenceSequence,
                               DCM_StructureSetROISequence,
                               DCM_ROIContourSequence,
                               DCM_RTROIObservationsSequence,
                               DCM_RegistrationSequence,
                               DCM_DeformableRegistrationSequence};

const std::array of_registrations{
    DCM_SpecificCharacterSet, DCM_SOPClassUID,          DCM_PatientID,
    DCM_FrameOfReferenceUID,  DCM_RegistrationSequence, DCM_DeformableRegistrationSequence};

}  // namespace

bool is_asked_for(std::uint32_t tag) {
  static const Tags tags = tags_of({of_series, of_slices, of_values, of_vendors});
  constexpr std::uint32_t siemens = 0x0029;  // its private headers
  return tag >> 16 == siemens || holds(tags, tag);
}

bool is_asked_for_of_structures(std::uint32_t tag) {
  static const Tags tags = tags_of({of_structures});
  return holds(tags, tag);
}

bool is_asked_for_of_registrations(std::uint32_t tag) {
  static const Tags tags = tags_of({of_registrations});
  return holds(tags, tag);
}

}  // namespace palpate::io::internal
