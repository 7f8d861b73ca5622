#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcsequen.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "io/dicom/character_set.h"
#include "io/dicom/dicom_value.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/color.h"
#include "io/structures/contour_planes.h"
#include "io/structures/structure_file.h"

namespace palpate::io {
namespace {

using internal::number_of;
using internal::numbers_of;
using internal::text_of;

/// The ROIs of one file.
class ContourSource final : public StructureSource {
 public:
  explicit ContourSource(std::map<int, std::vector<Contour>> rois) : rois_(std::move(rois)) {}

  StructureMeasures measure(int number, const RigidMotion& motion) const override {
    return measures_of(moved(number, motion));
  }
  std::shared_ptr<const DistanceField> distance(int number, const DistanceOptions& options) const override {
    const ContourStack stack = stack_of(moved(number, options.motion));
    return std::make_shared<const DistanceField>(planes_of(stack, options), options);
  }

 private:
  std::vector<Contour> moved(int number, const RigidMotion& motion) const {
    std::vector<Contour> contours = rois_.at(number);
    if (motion == RigidMotion()) return contours;
    for (Contour& contour : contours) {
      for (Vec3& point : contour) point = motion(point);
    }
    return contours;
  }

  std::map<int, std::vector<Contour>> rois_;
};

template <typename Work>
void for_items(DcmItem& item, const DcmTagKey& sequence, const Work& work) {
  DcmSequenceOfItems* items = nullptr;
  if (item.findAndGetSequence(sequence, items).bad()) {
    return;
  }
  DcmObject* object = nullptr;
  while ((object = items->nextInContainer(object)) != nullptr) {
    if (auto* one = dynamic_cast<DcmItem*>(object)) work(*one);
  }
}

Contour contour_in(DcmItem& item) {
  Contour contour;
  const std::vector<double> numbers = numbers_of(item, DCM_ContourData);
  if (numbers.empty() || numbers.size() % 3 != 0) {
    throw DicomError(say("contour-of-it-has-numbers", numbers.size()));
  }
  contour.reserve(numbers.size() / 3);
  for (std::size_t n = 0; n < numbers.size(); n += 3) {
    contour.push_back({numbers[n], numbers[n + 1], numbers[n + 2]});
  }
  return contour;
}

/// The closed contours of a ROI, and in `unfit` why it cannot be felt.
std::vector<Contour> closed_contours(DcmItem& roi, Text& unfit, std::vector<Text>& warnings) {
  std::vector<Contour> contours;
  std::map<std::string, int> others;
  for_items(roi, DCM_ContourSequence, [&](DcmItem& item) {
    const std::string type = text_of(item, DCM_ContourGeometricType);
    if (type == "CLOSED_PLANAR" || type == "CLOSEDPLANAR_XOR") {
      Contour contour = contour_in(item);
      if (contour.size() >= 3) contours.push_back(std::move(contour));
    } else {
      ++others[type];
    }
  });
  std::string open;
  for (const auto& [type, count] : others) {
    open += (open.empty() ? "" : ", ") + std::to_string(count) + " " + (type.empty() ? "of no type" : type);
  }
  if (contours.empty()) {
    unfit = open.empty() ? say("no-contour") : say("no-closed-contour", open);
  } else if (!open.empty()) {
    warnings.push_back(say("contours-that-are-not-closed-are-left", open));
  }
  return contours;
}

}  // namespace

std::vector<Structure> structures_of_contours(const StructureDataset& file) {
  DcmItem& dataset = file.dataset;
  const std::string characters = text_of(dataset, DCM_SpecificCharacterSet);
  std::map<int, Structure> structures;
  for_items(dataset, DCM_StructureSetROISequence, [&](DcmItem& item) {
    const auto number = number_of(item, DCM_ROINumber);
    if (!number) return;
    Structure structure;
    structure.kind = StructureKind::contours;
    structure.number = static_cast<int>(std::clamp(*number, -2e9, 2e9));
    structure.name = internal::utf8_of(text_of(item, DCM_ROIName), characters);
    if (structure.name.empty()) structure.name = "ROI " + std::to_string(structure.number);
    structure.frame_of_reference_uid = text_of(item, DCM_ReferencedFrameOfReferenceUID);
    structure.unfit = say("no-contour");
    structures.emplace(structure.number, std::move(structure));
  });
  if (structures.empty()) {
    throw DicomError(say("names-no-roi"));
  }
  std::map<int, std::vector<Contour>> rois;
  for_items(dataset, DCM_ROIContourSequence, [&](DcmItem& item) {
    const auto found = structures.find(
        static_cast<int>(std::clamp(number_of(item, DCM_ReferencedROINumber).value_or(-2e9), -2e9, 2e9)));
    if (found == structures.end()) return;
    Structure& structure = found->second;
    structure.color = color_of_rgb(numbers_of(item, DCM_ROIDisplayColor));
    structure.unfit.clear();
    try {
      rois[structure.number] = closed_contours(item, structure.unfit, structure.warnings);
      if (structure.unfit.empty()) stack_of(rois[structure.number]);  // refuses what does not lie in parallel planes
    } catch (const DicomError& error) {
      structure.unfit = error.text();
    }
  });
  const auto source = std::make_shared<const ContourSource>(std::move(rois));
  std::vector<Structure> list;
  list.reserve(structures.size());
  for (auto& [number, structure] : structures) {
    structure.source = source;
    list.push_back(std::move(structure));
  }
  return list;
}

}  // namespace palpate::io
