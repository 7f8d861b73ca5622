// DICOM PS3.3 A.19, C.8.8.5, C.8.8.6, C.8.8.8.

#include <fmt/format.h>

#include <utility>

#include "io/results/dicom_object.h"
// DCMTK's configuration comes first.
#include <dcmtk/dcmrt/drtstrct.h>

#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/color.h"
#include "io/structures/write_checks.h"

namespace palpate::io {
namespace {

/// A further item of a sequence.
template <typename Sequence>
typename Sequence::Item& add_item(Sequence& sequence) {
  typename Sequence::Item* item = nullptr;
  succeed(sequence.addItem(item));
  return *item;
}

template <typename Item>
void refer(const ReferencedImage& image, Item& item) {
  succeed(item.setReferencedSOPClassUID(image.sop_class.c_str()));
  succeed(item.setReferencedSOPInstanceUID(image.instance.c_str()));
}

void add_frame_of_reference(const StudyHeader& header, DRTStructureSetIOD& document) {
  auto& frame = add_item(document.getReferencedFrameOfReferenceSequence());
  succeed(frame.setFrameOfReferenceUID(header.frame_of_reference_uid.c_str()));
  auto& study = add_item(frame.getRTReferencedStudySequence());
  constexpr const char* retired_study_management = "1.2.840.10008.3.1.2.3.1";  // what PS3.3 C.8.8.5 has for a study
  refer({retired_study_management, header.study_uid}, study);
  auto& series = add_item(study.getRTReferencedSeriesSequence());
  succeed(series.setSeriesInstanceUID(header.series_uid.c_str()));
  for (const ReferencedImage& image : header.images) refer(image, add_item(series.getContourImageSequence()));
}

void add_contour(const std::vector<Vec3>& contour, const SliceImage& of, DRTContourSequence& contours) {
  auto& item = add_item(contours);
  if (!of.image.instance.empty()) {
    auto& image = add_item(item.getContourImageSequence());
    refer(of.image, image);
    if (of.frame > 0) succeed(image.setReferencedFrameNumber(std::to_string(of.frame).c_str()));
  }
  std::string data;
  for (const Vec3& point : contour) {
    data += fmt::format("{}{:.4f}\\{:.4f}\\{:.4f}", data.empty() ? "" : "\\", point.x, point.y, point.z);
  }
  succeed(item.setContourGeometricType("CLOSED_PLANAR"));
  succeed(item.setNumberOfContourPoints(std::to_string(contour.size()).c_str()));
  succeed(item.setContourData(data.c_str(), OFFalse));  // its check takes as long as all the rest
}

void add_roi(const SliceContours& contours, const std::vector<SliceImage>& images, const StudyHeader& header,
             DRTStructureSetIOD& document) {
  auto& roi = add_item(document.getStructureSetROISequence());
  succeed(roi.setROINumber("1"));
  succeed(roi.setReferencedFrameOfReferenceUID(header.frame_of_reference_uid.c_str()));
  succeed(roi.setROIName(long_string(contours.label.name).c_str(), OFFalse));  // UTF-8, of which it knows nothing
  succeed(roi.setROIGenerationAlgorithm("SEMIAUTOMATIC"));
  succeed(roi.setROIDescription(not_a_device));
  auto& outline = add_item(document.getROIContourSequence());
  succeed(outline.setReferencedROINumber("1"));
  if (const auto rgb = rgb_of_color(contours.label.color)) {
    succeed(outline.setROIDisplayColor(fmt::format("{}\\{}\\{}", (*rgb)[0], (*rgb)[1], (*rgb)[2]).c_str()));
  }
  for (const SliceContours::Slice& slice : contours.slices) {
    for (const std::vector<Vec3>& contour : slice.contours) {
      add_contour(contour, images[static_cast<std::size_t>(slice.k)], outline.getContourSequence());
    }
  }
  auto& observation = add_item(document.getRTROIObservationsSequence());
  succeed(observation.setObservationNumber("1"));
  succeed(observation.setReferencedROINumber("1"));
  succeed(observation.setRTROIInterpretedType(contours.label.interpreted_type.c_str()));
  succeed(observation.setROIInterpreter(""));
  const auto put = [](const Code& code, auto& sequence) {
    if (code.value.empty()) return;
    auto& coded = add_item(sequence);
    succeed(coded.setCodeValue(code.value.c_str()));
    succeed(coded.setCodingSchemeDesignator(code.scheme.c_str()));
    succeed(coded.setCodeMeaning(code.meaning.c_str(), OFFalse));
  };
  put(contours.label.type, observation.getRTROIIdentificationCodeSequence());
  put(contours.label.category, observation.getSegmentedPropertyCategoryCodeSequence());
}

/// How thick a slice alone is: contours of several slices say it by their distance. Retired, and read all the same;
/// dcmrt 3.6.9 does not know it.
void put_thickness(const SliceContours& contours, DcmDataset& data) {
  const DcmTagKey contour_slab_thickness(0x3006, 0x0044);
  DcmItem *outline = nullptr, *contour = nullptr;
  if (contours.slices.size() != 1) return;
  succeed(data.findAndGetSequenceItem(DCM_ROIContourSequence, outline));
  for (signed long n = 0; outline->findAndGetSequenceItem(DCM_ContourSequence, contour, n).good(); ++n) {
    const DcmTag tag(contour_slab_thickness, EVR_DS);
    succeed(contour->putAndInsertString(tag, decimal(contours.geometry.slice_spacing()).c_str()));
  }
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
  DRTStructureSetIOD document;
  succeed(document.setSOPInstanceUID(new_uid().c_str()));
  succeed(document.setStudyInstanceUID(header.study_uid.c_str()));
  succeed(document.setSeriesInstanceUID(new_uid().c_str()));
  succeed(document.setFrameOfReferenceUID(header.frame_of_reference_uid.c_str()));
  succeed(document.setModality("RTSTRUCT"));
  succeed(document.setStructureSetLabel("CORRECTED"));
  succeed(document.setStructureSetDate(date));
  succeed(document.setStructureSetTime(time));
  succeed(document.setApprovalStatus("UNAPPROVED"));
  succeed(document.setInstanceNumber("1"));
  if (const auto& origin = contours.label.origin; origin && origin->sop_class == UID_RTStructureSetStorage) {
    refer({origin->sop_class, origin->instance}, add_item(document.getPredecessorStructureSetSequence()));
  }
  add_frame_of_reference(header, document);
  add_roi(contours, images, header, document);
  DcmFileFormat format;
  succeed(document.write(*format.getDataset()));
  put_common(header, contours.label, scan, options, *format.getDataset());
  put_thickness(contours, *format.getDataset());
  // Explicit lengths of ContourData have 16 bits: a contour of 2000 points would not fit.
  write_whole(file, bytes_of(format, EXS_LittleEndianImplicit), existing(options));
}

}  // namespace palpate::io
