#include "io/structures/outline_change.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "io/structures/surface_points.h"

namespace palpate::io {
namespace {

/// The places that an edit is about, and how far from them the edge can move.
struct Around {
  const std::vector<Vec3>& places;
  double mm;
};

constexpr double seam_mm = 2;  // of what is joined or cut, and of the lattice

Around around(const TraceEdit& edit) {
  return {edit.points_mm, edit.reach_mm};
}
Around around(const AddEdit& edit) {
  return {edit.tube.path_mm, edit.tube.radius_mm};
}
Around around(const RemoveEdit& edit) {
  return {edit.tube.path_mm, edit.tube.radius_mm};
}

void widen(StructureBox& box, const Around& by) {
  for (const Vec3& place : by.places) {
    box.low_mm = glm::min(box.low_mm, place - by.mm - seam_mm);
    box.high_mm = glm::max(box.high_mm, place + by.mm + seam_mm);
  }
}

void widen_by(StructureBox& box, const ScanEdgeEdit& edit) {
  const std::vector<Vec3> center{edit.center_mm};
  widen(box, {center, edit.radius_mm + edit.most_mm});
}
void widen_by(StructureBox& box, const ContoursEdit& edit) {
  for (const std::vector<Vec3>& loop : edit.loops_mm) widen(box, {loop, 0});
}
template <typename Other>
void widen_by(StructureBox& box, const Other& edit) {
  widen(box, around(edit));
}

}  // namespace

std::optional<StructureBox> box_of_edits(std::span<const Edit> edits) {
  constexpr double most = std::numeric_limits<double>::infinity();
  StructureBox box{.low_mm = Vec3(most), .high_mm = Vec3(-most)};
  for (const Edit& edit : edits) std::visit([&](const auto& one) { widen_by(box, one); }, edit);
  if (box.low_mm.x > box.high_mm.x) return std::nullopt;
  return box;
}

OutlineChange outline_change(const DistanceField& before, const DistanceField& after, const StructureBox& box) {
  constexpr double finest_mm = 1, most_across = 200;
  const Vec3 extent = box.high_mm - box.low_mm;
  const double spacing = std::max(finest_mm, std::max({extent.x, extent.y, extent.z}) / most_across);
  const SignedDistance old = [&](const Vec3& at) { return before.sample(at).mm; };
  const SignedDistance now = [&](const Vec3& at) { return after.sample(at).mm; };
  OutlineChange change;
  const SharedVolume volume = shared_volume(old, now, box, spacing);
  change.added_mm3 = volume.second_mm3 - volume.both_mm3;
  change.removed_mm3 = volume.first_mm3 - volume.both_mm3;
  for (const auto& [of, to] : {std::pair{old, now}, std::pair{now, old}}) {
    for (const SurfacePoint& point : surface_points_in(of, box, spacing)) {
      const double mm = std::abs(to(point.at_mm));
      if (mm <= change.largest_mm) continue;
      change.largest_mm = mm;
      change.largest_at_mm = point.at_mm;
    }
  }
  return change;
}

}  // namespace palpate::io
