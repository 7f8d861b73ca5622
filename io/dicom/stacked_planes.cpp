#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcelem.h>
#include <dcmtk/dcmdata/dcitem.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "io/dicom/dicom_value.h"
#include "io/dicom/planes.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

// The attribute by which frames follow one another, as group << 16 | element; 0 if that is not said.
std::uint32_t increment_of(DcmItem& dataset) {
  DcmElement* element = nullptr;
  DcmTagKey tag;
  if (dataset.findAndGetElement(DCM_FrameIncrementPointer, element).bad() || element->getTagVal(tag, 0).bad()) return 0;
  return std::uint32_t{tag.getGroup()} << 16 | tag.getElement();
}

// Frames that are ordered by time, or by anything else than their position, are not a stack.
bool follow_by_place(DcmItem& dataset) {
  constexpr std::array by_place{0x3004000CU, 0x00540080U, 0x00180088U};  // offsets, SliceVector, SpacingBetweenSlices
  const std::uint32_t increment = increment_of(dataset);
  return increment == 0 || std::ranges::find(by_place, increment) != by_place.end();
}

// Nuclear medicine says the place of the first slice in a sequence (PS3.3 C.8.4.15).
std::optional<Placement> first_place(DcmItem& dataset, const Plane& plane) {
  if (plane.placement) return plane.placement;
  DcmItem* const detector = first_item(dataset, DCM_DetectorInformationSequence);
  if (detector == nullptr) return std::nullopt;
  return make_placement(numbers_of(*detector, DCM_ImagePositionPatient),
                        numbers_of(*detector, DCM_ImageOrientationPatient), numbers_of(dataset, DCM_PixelSpacing));
}

// Where each frame is along the normal, mm from the first one's; empty if that is not said.
std::vector<double> offsets_of(DcmItem& dataset, const Placement& first, std::size_t frames) {
  if (frames == 1) return {0};
  std::vector<double> offsets = numbers_of(dataset, DCM_GridFrameOffsetVector);
  if (offsets.size() >= frames) {
    offsets.resize(frames);
    // They count from the first plane, or are the planes' own z coordinates (PS3.3 C.8.8.3.2), which descend where the
    // normal points to the feet.
    const double start = offsets.front();
    const double sense = start != 0 && glm::cross(first.direction_i, first.direction_j).z < 0 ? -1 : 1;
    for (double& offset : offsets) offset = sense * (offset - start);
    return offsets;
  }
  offsets.clear();
  const auto spacing = number_of(dataset, DCM_SpacingBetweenSlices);
  if (!spacing || *spacing == 0) return {};
  for (std::size_t f = 0; f < frames; ++f) offsets.push_back(static_cast<double>(f) * *spacing);
  return offsets;
}

// Doses are stored in steps of DoseGridScaling (PS3.3 C.8.8.3).
void read_dose(DcmItem& dataset, FileHeader& header, Plane& plane) {
  const auto scaling = number_of(dataset, DCM_DoseGridScaling);
  if (!scaling || !(*scaling > 0)) {
    header.unfit = say("dose-without-its-scaling");
    return;
  }
  plane.slope = *scaling;
  plane.intercept = 0;
  header.unit = text_of(dataset, DCM_DoseUnits) == "GY" ? "Gy" : "";
}

}  // namespace

std::vector<Plane> stacked_planes(DcmItem& dataset, FileHeader& header, std::size_t frames) {
  Plane plane = classic_plane(dataset, header);
  if (header.modality == "RTDOSE") read_dose(dataset, header, plane);
  const auto first = first_place(dataset, plane);
  const bool by_place = follow_by_place(dataset);
  const auto offsets = first && by_place ? offsets_of(dataset, *first, frames) : std::vector<double>();
  if (offsets.empty()) {
    if (header.unfit.empty()) header.unfit = say("several-frames-without-a-position-for-each");
    return {std::move(plane)};
  }
  const Vec3 normal = glm::cross(first->direction_i, first->direction_j);
  std::vector<Plane> planes;
  for (std::size_t f = 0; f < frames; ++f) {
    plane.frame = static_cast<std::uint32_t>(f);
    plane.placement = first;
    plane.placement->position += offsets[f] * normal;
    planes.push_back(plane);
  }
  return planes;
}

}  // namespace palpate::io::internal
