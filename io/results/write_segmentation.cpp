// DICOM PS3.3 A.51, C.8.20.

#include <algorithm>
#include <memory>

#include "io/results/dicom_object.h"
// DCMTK's configuration comes first.
#include <dcmtk/dcmfg/fgderimg.h>
#include <dcmtk/dcmfg/fgfracon.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmiod/iodreferences.h>
#include <dcmtk/dcmseg/segdoc.h>
#include <dcmtk/dcmseg/segment.h>

#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/color.h"
#include "io/structures/write_checks.h"
#include "io/whole_file.h"

namespace palpate::io {
namespace {

const Code tissue{"85756007", "SCT", "Tissue"};  // where nobody says more

const Code& known(const Code& code) {
  return code.value.empty() || code.scheme.empty() || code.meaning.empty() ? tissue : code;
}

/// DCMTK's classes refuse letters outside ASCII and long values: put_codes() writes the codes themselves.
CodeSequenceMacro code_to_come() {
  return {tissue.value.c_str(), tissue.scheme.c_str(), tissue.meaning.c_str()};
}

void add_segment(const StructureLabel& label, DcmSegmentation& document) {
  DcmSegment* made = nullptr;
  succeed(DcmSegment::create(made, "1", code_to_come(), code_to_come(), DcmSegTypes::SAT_SEMIAUTOMATIC, "Palpate"));
  std::unique_ptr<DcmSegment> segment(made);
  succeed(segment->setSegmentDescription(not_a_device));
  for (std::size_t n = 0; n < label.modifiers.size(); ++n) {
    segment->getSegmentedPropertyTypeModifierCode().push_back(new CodeSequenceMacro(code_to_come()));
  }
  if (const auto rgb = rgb_of_color(label.color)) {
    const auto [l, a, b] = lab_of_rgb(*rgb);
    succeed(segment->setRecommendedDisplayCIELabValue(l, a, b));
  }
  Uint16 number = 0;
  succeed(document.addSegment(segment.get(), number));
  segment.release();  // the document's
}

void put_codes(const StructureLabel& label, DcmItem& segment) {
  const auto put = [](DcmItem& item, const DcmTagKey& sequence, const Code& code, long number) {
    DcmItem* found = nullptr;
    succeed(item.findAndGetSequenceItem(sequence, found, number));
    put_code(*found, known(code));
    return found;
  };
  put(segment, DCM_SegmentedPropertyCategoryCodeSequence, label.category, 0);
  DcmItem* const type = put(segment, DCM_SegmentedPropertyTypeCodeSequence, label.type, 0);
  long number = 0;
  for (const Code& modifier : label.modifiers) {
    put(*type, DCM_SegmentedPropertyTypeModifierCodeSequence, modifier, number++);
  }
}

/// Texts in UTF-8, which DCMTK's classes take for wrong.
void put_texts(const StructureLabel& label, DcmDataset& data) {
  DcmItem* segment = nullptr;
  succeed(data.findAndGetSequenceItem(DCM_SegmentSequence, segment));
  put_codes(label, *segment);
  succeed(segment->putAndInsertString(DCM_SegmentLabel, long_string(label.name).c_str()));
  if (label.tracking_id.empty() || label.tracking_uid.empty()) return;
  succeed(segment->putAndInsertString(DCM_TrackingID, label.tracking_id.c_str()));
  succeed(segment->putAndInsertString(DCM_TrackingUID, label.tracking_uid.c_str()));
}

/// Bits one behind the other, the lowest of a byte first, frames not padded (PS3.5 8.1.1, PS3.3 C.8.20.2.1).
/// DCMTK 3.6.7 shifts some frames by a pixel where the bits of a frame do not fill its last byte.
void put_pixels(const LabelImage& image, int first, int last, DcmDataset& data) {
  const std::size_t from = image.offset(0, 0, first), count = image.offset(0, 0, last + 1) - from;
  std::vector<Uint8> bytes((count + 15) / 16 * 2);  // an even number of them
  for (std::size_t n = 0; n < count; ++n) {
    if (image.inside[from + n] != 0) bytes[n / 8] = static_cast<Uint8>(bytes[n / 8] | 1U << n % 8);
  }
  succeed(data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), static_cast<unsigned long>(bytes.size())));
}

void add_shared_groups(const Geometry& geometry, DcmSegmentation& document) {
  const Vec3 &i = geometry.direction_i, &j = geometry.direction_j;
  const auto text = [](double number) { return OFString(decimal(number).c_str()); };
  const std::unique_ptr<FGPlaneOrientationPatient> orientation(
      FGPlaneOrientationPatient::createMinimal(text(i.x), text(i.y), text(i.z), text(j.x), text(j.y), text(j.z)));
  FGPixelMeasures measures;
  succeed(measures.setPixelSpacing(text(geometry.spacing_j) + "\\" + text(geometry.spacing_i)));
  succeed(measures.setSliceThickness(text(geometry.slice_spacing())));
  // Uneven slices have no spacing: only their positions are written.
  if (geometry.uniform) succeed(measures.setSpacingBetweenSlices(text(geometry.slice_spacing())));
  succeed(document.addForAllFrames(*orientation));
  succeed(document.addForAllFrames(measures));
}

void add_frame(const LabelImage& image, const SliceImage& of, int k, int first, DcmSegmentation& document) {
  const auto text = [](double number) { return OFString(decimal(number).c_str()); };
  const Vec3& at = image.geometry.slice_positions[static_cast<std::size_t>(k)];
  const std::unique_ptr<FGPlanePosPatient> position(
      FGPlanePosPatient::createMinimal(text(at.x), text(at.y), text(at.z)));
  const auto number = static_cast<Uint32>(k - first + 1);
  FGFrameContent content;
  succeed(content.setStackID("1"));
  succeed(content.setInStackPositionNumber(number));
  succeed(content.setDimensionIndexValues(1, 0));
  succeed(content.setDimensionIndexValues(number, 1));
  OFVector<FGBase*> groups;
  groups.push_back(position.get());
  groups.push_back(&content);
  std::unique_ptr<FGDerivationImage> derivation;
  if (!of.image.instance.empty()) {
    ImageSOPInstanceReferenceMacro reference;
    succeed(reference.setReferencedSOPClassUID(of.image.sop_class.c_str()));
    succeed(reference.setReferencedSOPInstanceUID(of.image.instance.c_str()));
    if (of.frame > 0) succeed(reference.addReferencedFrameNumber(static_cast<Uint16>(of.frame)));
    OFVector<ImageSOPInstanceReferenceMacro> references;
    references.push_back(reference);
    derivation.reset(DcmSegmentation::createDerivationImageFG(references, "Segmentation"));
    groups.push_back(derivation.get());
  }
  const std::size_t from = image.offset(0, 0, k), to = image.offset(0, 0, k + 1);
  std::vector<Uint8> pixels(image.inside.begin() + static_cast<std::ptrdiff_t>(from),
                            image.inside.begin() + static_cast<std::ptrdiff_t>(to));
  succeed(document.addFrame(pixels.data(), 1, groups));
}

void add_references(const StudyHeader& header, const StructureLabel& label, DcmSegmentation& document) {
  IODReferences references;
  const auto add = [&](const std::string& study, const std::string& series, const ReferencedImage& image) {
    references.add(
        new IODImageReference("", study.c_str(), series.c_str(), image.instance.c_str(), image.sop_class.c_str()));
  };
  for (const ReferencedImage& image : header.images) add(header.study_uid, image.series_uid, image);
  if (const auto& origin = label.origin; origin && !origin->instance.empty()) {
    add(origin->study_uid, origin->series_uid, {origin->sop_class, origin->instance, origin->series_uid});
  }
  document.getCommonInstanceReference().addReferences(references, header.study_uid.c_str());
}

}  // namespace

void write_segmentation(const LabelImage& image, const Series& scan, const std::filesystem::path& file,
                        const WriteOptions& options) {
  check_target(image.label, file, options);
  const auto [first, last] = occupied_slices(image);
  const std::vector<SliceImage> images = images_of_slices(scan, image.geometry, options.frame);
  const StudyHeader header = read_study_header(scan);
  DcmSegmentation* made = nullptr;
  const ContentIdentificationMacro content("1", "CORRECTED", "Corrected outline", "");
  succeed(DcmSegmentation::createBinarySegmentation(
      made, static_cast<Uint16>(image.geometry.dimensions.y), static_cast<Uint16>(image.geometry.dimensions.x),
      IODGeneralEquipmentModule::EquipmentInfo("Palpate", "Palpate", "0", options.software_version.c_str()), content));
  const std::unique_ptr<DcmSegmentation> document(made);
  succeed(document->getStudy().setStudyInstanceUID(header.study_uid.c_str()));
  succeed(document->getFrameOfReference().setFrameOfReferenceUID(header.frame_of_reference_uid.c_str()));
  succeed(document->getSeries().setSeriesNumber("1"));
  add_segment(image.label, *document);
  add_shared_groups(image.geometry, *document);
  const std::string dimensions = new_uid();
  succeed(document->getDimensions().addDimensionIndex(DCM_ReferencedSegmentNumber, dimensions.c_str(),
                                                      DCM_SegmentIdentificationSequence, "Segment"));
  succeed(document->getDimensions().addDimensionIndex(DCM_ImagePositionPatient, dimensions.c_str(),
                                                      DCM_PlanePositionSequence, "Position"));
  for (int k = first; k <= last; ++k) {
    add_frame(image, images[static_cast<std::size_t>(k)], k, first, *document);
  }
  add_references(header, image.label, *document);
  DcmFileFormat format;
  succeed(document->writeDataset(*format.getDataset()));
  put_common(header, image.label, scan, options, *format.getDataset());
  put_texts(image.label, *format.getDataset());
  put_pixels(image, first, last, *format.getDataset());
  write_whole(file, bytes_of(format, EXS_LittleEndianExplicit), existing(options));
}

}  // namespace palpate::io
