// DICOM PS3.3 A.19, C.8.8.5, C.8.8.6, C.8.8.8.

#include <fmt/format.h>

#include <map>
#include <string>

#include "io/errors.h"
#include "io/messages.h"
#include "io/results/dicom_object.h"
#include "io/structures/color.h"
#include "io/structures/write_checks.h"

namespace palpate::io {
namespace {

// By dcmdata alone: to be linked with dcmrt, which knows this object, costs each start of the program 5 ms.

void put_text(DcmItem& item, const DcmTagKey& key, const std::string& value) {
  succeed(item.putAndInsertString(key, value.c_str()));
}

/// A further item of a sequence.
DcmItem& add_item(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* added = nullptr;
  succeed(item.findOrCreateSequenceItem(sequence, added, -2));
  return *added;
}

void refer(const ReferencedImage& image, DcmItem& item) {
  put_text(item, DCM_ReferencedSOPClassUID, image.sop_class);
  put_text(item, DCM_ReferencedSOPInstanceUID, image.instance);
}

void add_frame_of_reference(const StudyHeader& header, DcmItem& data) {
  DcmItem& frame = add_item(data, DCM_ReferencedFrameOfReferenceSequence);
  put_text(frame, DCM_FrameOfReferenceUID, header.frame_of_reference_uid);
  DcmItem& study = add_item(frame, DCM_RTReferencedStudySequence);
  constexpr const char* retired_study_management = "1.2.840.10008.3.1.2.3.1";  // what PS3.3 C.8.8.5 has for a study
  refer({retired_study_management, header.study_uid}, study);
  std::map<std::string, DcmItem*> series;
  for (const ReferencedImage& image : header.images) {
    DcmItem*& its = series[image.series_uid];
    if (its == nullptr) {
      its = &add_item(study, DCM_RTReferencedSeriesSequence);
      put_text(*its, DCM_SeriesInstanceUID, image.series_uid);
    }
    refer(image, add_item(*its, DCM_ContourImageSequence));
  }
}

/// How thick a slice alone is: contours of several slices say it by their distance. Retired, and read all the same.
void put_thickness(const SliceContours& contours, DcmItem& contour) {
  const DcmTag contour_slab_thickness(0x3006, 0x0044, EVR_DS);
  if (contours.slices.size() != 1) return;
  succeed(contour.putAndInsertString(contour_slab_thickness, decimal(contours.geometry.slice_spacing()).c_str()));
}

void add_contour(const std::vector<Vec3>& points, const SliceImage& of, DcmItem& contour) {
  if (!of.image.instance.empty()) {
    DcmItem& image = add_item(contour, DCM_ContourImageSequence);
    refer(of.image, image);
    if (of.frame > 0) put_text(image, DCM_ReferencedFrameNumber, std::to_string(of.frame));
  }
  std::string data;
  for (const Vec3& point : points) {
    data += fmt::format("{}{:.4f}\\{:.4f}\\{:.4f}", data.empty() ? "" : "\\", point.x, point.y, point.z);
  }
  put_text(contour, DCM_ContourGeometricType, "CLOSED_PLANAR");
  put_text(contour, DCM_NumberOfContourPoints, std::to_string(points.size()));
  put_text(contour, DCM_ContourData, data);
}

void add_observation(const StructureLabel& label, DcmItem& data) {
  DcmItem& observation = add_item(data, DCM_RTROIObservationsSequence);
  put_text(observation, DCM_ObservationNumber, "1");
  put_text(observation, DCM_ReferencedROINumber, "1");
  put_text(observation, DCM_RTROIInterpretedType, label.interpreted_type);
  put_text(observation, DCM_ROIInterpreter, "");
  const auto put = [&](const Code& code, const DcmTagKey& sequence) {
    if (!code.value.empty()) put_code(observation, sequence, code);
  };
  put(label.type, DCM_RTROIIdentificationCodeSequence);
  put(label.category, DCM_SegmentedPropertyCategoryCodeSequence);
}

void add_roi(const SliceContours& contours, const std::vector<SliceImage>& images, const StudyHeader& header,
             DcmItem& data) {
  DcmItem& roi = add_item(data, DCM_StructureSetROISequence);
  put_text(roi, DCM_ROINumber, "1");
  put_text(roi, DCM_ReferencedFrameOfReferenceUID, header.frame_of_reference_uid);
  put_text(roi, DCM_ROIName, long_string(contours.label.name));
  put_text(roi, DCM_ROIGenerationAlgorithm, "SEMIAUTOMATIC");
  put_text(roi, DCM_ROIDescription, not_a_device);
  DcmItem& outline = add_item(data, DCM_ROIContourSequence);
  put_text(outline, DCM_ReferencedROINumber, "1");
  if (const auto rgb = rgb_of_color(contours.label.color)) {
    put_text(outline, DCM_ROIDisplayColor, fmt::format("{}\\{}\\{}", (*rgb)[0], (*rgb)[1], (*rgb)[2]));
  }
  for (const SliceContours::Slice& slice : contours.slices) {
    for (const std::vector<Vec3>& points : slice.contours) {
      DcmItem& contour = add_item(outline, DCM_ContourSequence);
      add_contour(points, images[static_cast<std::size_t>(slice.k)], contour);
      put_thickness(contours, contour);
    }
  }
  add_observation(contours.label, data);
}

}  // namespace

void write_contours(const SliceContours& contours, const Series& scan, const std::filesystem::path& file,
                    const WriteOptions& options) {
  check_target(contours.label, file, options);
  if (contours.slices.empty()) throw DicomError(say("outline-is-empty", contours.label.name));
  const std::vector<SliceImage> images = images_of_slices(scan, contours.geometry, options.frame);
  const StudyHeader header = read_study_header(scan);
  OFString date, time;
  DcmDate::getCurrentDate(date);
  DcmTime::getCurrentTime(time);
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  put_text(data, DCM_SOPClassUID, UID_RTStructureSetStorage);
  put_text(data, DCM_FrameOfReferenceUID, header.frame_of_reference_uid);
  put_text(data, DCM_PositionReferenceIndicator, "");
  put_text(data, DCM_Modality, "RTSTRUCT");
  put_text(data, DCM_OperatorsName, "");
  put_text(data, DCM_StructureSetLabel, "CORRECTED");
  put_text(data, DCM_StructureSetDate, date.c_str());
  put_text(data, DCM_StructureSetTime, time.c_str());
  put_text(data, DCM_ApprovalStatus, "UNAPPROVED");
  put_text(data, DCM_InstanceNumber, "1");
  if (const auto& origin = contours.label.origin; origin && origin->sop_class == UID_RTStructureSetStorage) {
    refer({origin->sop_class, origin->instance}, add_item(data, DCM_PredecessorStructureSetSequence));
  }
  add_frame_of_reference(header, data);
  add_roi(contours, images, header, data);
  put_common(header, contours.label, scan, options, data);
  // Explicit lengths of ContourData have 16 bits: a contour of 2000 points would not fit.
  write_whole(file, bytes_of(format, EXS_LittleEndianImplicit), existing(options));
}

}  // namespace palpate::io
