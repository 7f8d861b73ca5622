#include "io/structures/placed_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcsequen.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "io/dicom/dicom_value.h"
#include "io/dicom/file_header.h"
#include "io/errors.h"
#include "io/messages.h"
#include "io/reach.h"

namespace palpate::io {

using internal::first_item;
using internal::numbers_of;
using internal::Placement;

namespace {

/// A frame's group, or the shared one if it has none of its own.
DcmItem* group_of(DcmItem& own, DcmItem* shared, const DcmTagKey& sequence) {
  DcmItem* found = first_item(own, sequence);
  return found != nullptr || shared == nullptr ? found : first_item(*shared, sequence);
}

std::vector<double> numbers_in(DcmItem* item, const DcmTagKey& tag) {
  return item != nullptr ? numbers_of(*item, tag) : std::vector<double>();
}

/// A distance in the file; 0 if it is missing, or impossible for a patient.
double distance_in(DcmItem* measures, const DcmTagKey& tag) {
  const std::vector<double> numbers = numbers_in(measures, tag);
  const double distance = numbers.empty() ? 0 : std::abs(numbers.front());
  return distance <= internal::farthest_place_mm ? distance : 0;
}

bool is_within_reach(const Placement& placement) {
  return glm::length(placement.position) <= internal::farthest_place_mm &&
         std::max(placement.spacing_i, placement.spacing_j) <= internal::farthest_place_mm &&
         std::min(placement.spacing_i, placement.spacing_j) >= internal::least_spacing_mm;
}

PlacedFrame placed_frame(DcmItem& own, DcmItem* shared, SegmentationType type) {
  DcmItem* position = group_of(own, shared, DCM_PlanePositionSequence);
  DcmItem* measures = group_of(own, shared, DCM_PixelMeasuresSequence);
  const auto placement = internal::make_placement(
      numbers_in(position, DCM_ImagePositionPatient),
      numbers_in(group_of(own, shared, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient),
      numbers_in(measures, DCM_PixelSpacing));
  if (!placement) {
    throw DicomError(say("frame-without-a-position"));
  }
  if (!is_within_reach(*placement)) throw DicomError(say("frame-beyond-any-patient"));
  PlacedFrame frame{.placement = *placement};
  frame.spacing = distance_in(measures, DCM_SpacingBetweenSlices);
  frame.thickness = distance_in(measures, DCM_SliceThickness);
  DcmItem* content = group_of(own, shared, DCM_FrameContentSequence);
  const auto in_stack = numbers_in(content, DCM_InStackPositionNumber);
  if (content != nullptr) frame.stack = internal::text_of(*content, DCM_StackID);
  if (!in_stack.empty()) frame.in_stack = static_cast<int>(std::clamp(in_stack.front(), -1.0, 1e6));
  if (type != SegmentationType::label_map) {
    const auto number =
        numbers_in(group_of(own, shared, DCM_SegmentIdentificationSequence), DCM_ReferencedSegmentNumber);
    if (number.empty()) {
      throw DicomError(say("frame-without-a-segment"));
    }
    frame.segment = static_cast<int>(std::clamp(number.front(), 0.0, 65535.0));
  }
  return frame;
}

}  // namespace

std::vector<PlacedFrame> placed_frames(DcmItem& dataset, SegmentationType type, std::size_t count) {
  std::vector<PlacedFrame> frames;
  DcmSequenceOfItems* per_frame = nullptr;
  if (dataset.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, per_frame).bad()) {
    throw DicomError(say("does-not-say-where-its-frames"));
  }
  DcmItem* const shared = first_item(dataset, DCM_SharedFunctionalGroupsSequence);
  DcmObject* object = nullptr;
  while (frames.size() < count && (object = per_frame->nextInContainer(object)) != nullptr) {
    auto* own = dynamic_cast<DcmItem*>(object);
    if (own == nullptr) break;
    frames.push_back(placed_frame(*own, shared, type));
  }
  if (frames.size() < count) {
    throw DicomError(say("frames-without-a-position", frames.size(), count));
  }
  return frames;
}

bool share_lattice(const Placement& a, const Placement& b) {
  constexpr double tolerance = 1e-3;
  return glm::length(a.direction_i - b.direction_i) < tolerance &&
         glm::length(a.direction_j - b.direction_j) < tolerance &&
         std::abs(a.spacing_i - b.spacing_i) < tolerance * a.spacing_i &&
         std::abs(a.spacing_j - b.spacing_j) < tolerance * a.spacing_j;
}

FrameSlices slices_of(const std::vector<PlacedFrame>& frames, const Vec3& normal) {
  const Placement& reference = frames.front().placement;
  const double same = internal::same_place_mm(reference);
  FrameSlices slices;
  std::vector<std::size_t> order(frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto height_of = [&](std::size_t n) { return glm::dot(frames[n].placement.position, normal); };
  std::ranges::stable_sort(order, {}, height_of);
  for (const std::size_t n : order) {
    const Vec3& position = frames[n].placement.position;
    const double height = height_of(n);
    if (slices.height.empty() || height > slices.height.back() + same) {
      slices.position.push_back(position);
      slices.height.push_back(height);
      slices.frames.emplace_back();
    }
    const Vec3 aside = position - slices.position.back() - (height - slices.height.back()) * normal;
    if (glm::length(aside) > same) throw DicomError(say("frames-lie-beside-each-other"));
    slices.frames.back().push_back(n);
  }
  return slices;
}

namespace {

/// Whether frames are numbered by their slices. Some programs count the frames: then no number is there twice, though
/// slices have several frames.
bool are_slices_numbered(const FrameSlices& slices, const std::vector<PlacedFrame>& frames) {
  std::set<std::pair<std::string, int>> numbers;
  for (const PlacedFrame& frame : frames) {
    if (frame.in_stack && !numbers.emplace(frame.stack, *frame.in_stack).second) return true;
  }
  return std::ranges::all_of(slices.frames, [](const auto& of_slice) { return of_slice.size() < 2; });
}

/// How many slices a frame lies after one of its segment and stack on the slice before, as both are numbered; 0 if they
/// are not.
int numbered_steps(const std::vector<PlacedFrame>& frames, const std::vector<std::size_t>& before,
                   const std::vector<std::size_t>& after) {
  std::map<std::pair<std::string, int>, int> number;  // by stack and segment
  for (const std::size_t n : before) {
    const PlacedFrame& frame = frames[n];
    if (frame.in_stack) number.try_emplace({frame.stack, frame.segment}, *frame.in_stack);
  }
  for (const std::size_t n : after) {
    const auto found = number.find({frames[n].stack, frames[n].segment});
    if (found != number.end() && frames[n].in_stack) return std::abs(*frames[n].in_stack - found->second);
  }
  return 0;
}

}  // namespace

std::vector<int> steps_between(const FrameSlices& slices, const std::vector<PlacedFrame>& frames) {
  const double spacing = frames.front().spacing;
  const std::size_t count = slices.height.size() - 1;
  std::vector<int> steps(count, 1);
  double least = spacing;
  for (std::size_t k = 0; k < count; ++k) {
    const double step = slices.height[k + 1] - slices.height[k];
    least = least > 0 ? std::min(least, step) : step;
  }
  constexpr double tolerance = 0.05;
  constexpr double most = 4096, most_of_all = 16384;  // slices between two, and together: more is no lattice
  double total = 1;
  const Placement& pixels = frames.front().placement;
  const double thinnest = 0.1 * std::min(pixels.spacing_i, pixels.spacing_j);  // mm: no slice is that flat
  const bool has_numbers = !(spacing > 0) && are_slices_numbered(slices, frames);
  for (std::size_t k = 0; k < count; ++k) {
    const double apart = slices.height[k + 1] - slices.height[k];
    int numbered = has_numbers ? numbered_steps(frames, slices.frames[k], slices.frames[k + 1]) : 0;
    if (numbered * thinnest > apart) numbered = 0;
    const double in_steps = apart / least;
    const double whole = numbered > 0 ? numbered : std::round(in_steps);
    const bool is_whole = numbered > 0 || std::abs(in_steps - whole) <= tolerance * whole;
    total += whole;
    if (!is_whole || whole > most || total > most_of_all) return std::vector<int>(count, 1);
    steps[k] = static_cast<int>(whole);
  }
  return steps;
}

}  // namespace palpate::io
