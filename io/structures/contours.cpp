#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcsequen.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <utility>

#include "io/dicom/character_set.h"
#include "io/dicom/dicom_value.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/quantile.h"
#include "io/reach.h"
#include "io/structures/color.h"
#include "io/structures/contour_planes.h"
#include "io/structures/structure_file.h"

namespace palpate::io {
namespace {

/// Retired in 2008; programs still write it.
const DcmTagKey contour_slab_thickness(0x3006, 0x0044);

using internal::number_of;
using internal::numbers_of;
using internal::text_of;

struct Roi {
  std::vector<Contour> contours;
  std::map<std::string, int> others;  ///< how many contours of each type that is not closed
  ContourRule rule;
  bool is_broken = false;  ///< one of its items cannot be read
};

/// The ROIs of one file.
class ContourSource final : public StructureSource {
 public:
  explicit ContourSource(std::map<int, Roi> rois) : rois_(std::move(rois)) {}

  StructureMeasures measure(int number, const RigidMotion& motion, const Geometry* scan) const override {
    const std::vector<Contour> contours = moved(number, motion);
    return measures_of(contours, rule_on(scan, number, contours));
  }
  std::shared_ptr<const DistanceField> distance(int number, const DistanceOptions& options) const override {
    const std::vector<Contour> contours = moved(number, options.motion);
    const ContourStack stack = stack_of(contours, rule_on(options.scan, number, contours));
    return std::make_shared<const DistanceField>(planes_of(stack, options), options);
  }

 private:
  /// Where the file says nothing of how thick a plane alone is, it is as thick as the scan's voxels.
  ContourRule rule_on(const Geometry* scan, int number, const std::vector<Contour>& contours) const {
    ContourRule rule = rois_.at(number).rule;
    if (scan != nullptr && !(rule.thickness_mm > 0)) {
      rule.thickness_mm = thickness_of_voxels(*scan, stack_of(contours, rule).axes[2]);
    }
    return rule;
  }
  std::vector<Contour> moved(int number, const RigidMotion& motion) const {
    std::vector<Contour> contours = rois_.at(number).contours;
    if (motion == RigidMotion()) return contours;
    for (Contour& contour : contours) {
      for (Vec3& point : contour) point = motion(point);
    }
    return contours;
  }

  std::map<int, Roi> rois_;
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
    const bool is_near = glm::length(contour.back()) <= internal::farthest_place_mm;  // nor is what is no number
    if (!is_near) throw DicomError(say("contour-beyond-any-patient"));
  }
  return contour;
}

/// The contours of one item. Some files hold several items of a ROI: its contours are those of all.
void add_contours(DcmItem& item_of_roi, Roi& roi) {
  for_items(item_of_roi, DCM_ContourSequence, [&](DcmItem& item) {
    const std::string type = text_of(item, DCM_ContourGeometricType);
    if (type == "CLOSED_PLANAR" || type == "CLOSEDPLANAR_XOR") {
      Contour contour = contour_in(item);
      if (contour.size() < 3) return;
      roi.contours.push_back(std::move(contour));
      roi.rule.is_exclusive = roi.rule.is_exclusive || type == "CLOSEDPLANAR_XOR";
      const double thickness = number_of(item, contour_slab_thickness).value_or(0);
      if (thickness <= internal::farthest_place_mm) roi.rule.thickness_mm = std::max(roi.rule.thickness_mm, thickness);
    } else {
      ++roi.others[internal::utf8_of(type, {})];
    }
  });
}

void take_item(DcmItem& item, Roi& roi, Structure& structure) {
  if (const std::string color = color_of_rgb(numbers_of(item, DCM_ROIDisplayColor)); !color.empty()) {
    structure.color = color;
  }
  if (roi.is_broken) return;
  try {
    add_contours(item, roi);
  } catch (const DicomError& error) {
    structure.unfit = error.text();
    roi.is_broken = true;
  }
}

/// Says why a ROI cannot be felt, or what of it is left out.
void judge(const Roi& roi, Structure& structure) {
  if (roi.is_broken) return;
  std::string open;
  for (const auto& [type, count] : roi.others) {
    open += (open.empty() ? "" : ", ") + std::to_string(count) + " " + (type.empty() ? "of no type" : type);
  }
  structure.unfit = Text();
  if (roi.contours.empty()) {
    structure.unfit = open.empty() ? say("no-contour") : say("no-closed-contour", open);
  } else if (!open.empty()) {
    structure.warnings.push_back(say("contours-that-are-not-closed-are-left", open));
  }
}

/// Refuses what does not lie in parallel planes. Returns how far apart the planes of each of the others lie.
std::vector<double> check_planes(const std::map<int, Roi>& rois, std::map<int, Structure>& structures) {
  std::vector<double> steps_mm;
  for (const auto& [number, roi] : rois) {
    Structure& structure = structures.at(number);
    if (!structure.unfit.empty()) continue;
    try {
      const ContourStack stack = stack_of(roi.contours, roi.rule);
      std::ranges::copy(stack.warnings, std::back_inserter(structure.warnings));
      if (stack.planes.size() > 1) steps_mm.push_back(stack.step_mm);
    } catch (const DicomError& error) {
      structure.unfit = error.text();
    }
  }
  return steps_mm;
}

/// A plane alone is as thick as the planes of the file's other ROIs are apart: all lie on the same scan.
void give_thickness(std::map<int, Roi>& rois, std::vector<double> steps_mm) {
  if (steps_mm.empty()) return;
  const double typical = quantile(std::move(steps_mm), 0.5);
  for (auto& [number, roi] : rois) {
    if (!(roi.rule.thickness_mm > 0)) roi.rule.thickness_mm = typical;
  }
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
  std::map<int, Roi> rois;
  for_items(dataset, DCM_ROIContourSequence, [&](DcmItem& item) {
    const auto found = structures.find(
        static_cast<int>(std::clamp(number_of(item, DCM_ReferencedROINumber).value_or(-2e9), -2e9, 2e9)));
    if (found != structures.end()) take_item(item, rois[found->first], found->second);
  });
  for (const auto& [number, roi] : rois) judge(roi, structures.at(number));
  std::vector<double> steps_mm = check_planes(rois, structures);
  give_thickness(rois, std::move(steps_mm));
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
