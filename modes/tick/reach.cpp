#include "modes/tick/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

namespace palpate::modes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Interval {
  double low = infinity, high = -infinity;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool meets(const Interval& other) const { return low <= other.high && high >= other.low; }
};

/// What lies between a slice and the next one, and the device's box, are both convex: an axis along which they do not
/// overlap separates them. Looked for among the box's axes and the slices' normal.
bool is_within_reach(const io::Geometry& geometry, int slice, const Workspace& workspace, const Vec3& half_extent_m) {
  const int next = std::min(slice + 1, geometry.dimensions.z - 1);
  std::array<Interval, 3> between;
  for (const int k : {slice, next}) {
    for (const double j : {0.0, geometry.dimensions.y - 1.0}) {
      for (const double i : {0.0, geometry.dimensions.x - 1.0}) {
        const Vec3 corner = workspace.to_device(geometry.to_patient({i, j, k}));
        for (int axis = 0; axis < 3; ++axis) between[static_cast<std::size_t>(axis)].add(corner[axis]);
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!between[static_cast<std::size_t>(axis)].meets({-half_extent_m[axis], half_extent_m[axis]})) return false;
  }
  const Vec3 normal = glm::cross(geometry.direction_i, geometry.direction_j);
  Interval slices, box;
  for (const int k : {slice, next}) slices.add(glm::dot(normal, geometry.slice_positions[static_cast<std::size_t>(k)]));
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    box.add(glm::dot(normal, workspace.to_patient(sign * half_extent_m)));
  }
  return slices.meets(box);
}

}  // namespace

io::SliceRange slices_within_reach(const io::Geometry& geometry, const Workspace& workspace,
                                   const Vec3& half_extent_m) {
  const int last = geometry.dimensions.z - 1;
  io::SliceRange reached{.first = last + 1, .last = -1};
  for (int slice = 0; slice < std::max(last, 1); ++slice) {
    if (is_within_reach(geometry, slice, workspace, half_extent_m)) {
      reached.first = std::min(reached.first, slice);
      reached.last = std::min(slice + 1, last);
    }
  }
  return reached;
}

void leave_out_slices(const io::Geometry& geometry, const Vec3& half_extent_m, Plan& plan) {
  double most_n = 0;
  for (const ActiveMode& mode : plan.modes) most_n += mode.strength.most_n();
  // In whole centimeters: a strength that is being edited shall not take away what was computed before.
  const double beyond_m = 0.01 * std::ceil(most_n / plan.stiffness_n_per_m / 0.01);
  plan.slices = slices_within_reach(geometry, plan.workspace, half_extent_m + Vec3(beyond_m));
  const auto leave_out = [&plan](int first, int last) {
    if (first > last) return;
    std::string what = first < last ? "slices " : "slice ";
    what.append(std::to_string(first));
    if (first < last) what.append(1, '-').append(std::to_string(last));
    plan.left_out.push_back({.what = what,
                             .why = "outside the workspace",
                             .saves = "computing their fields ahead, and keeping them",
                             .slices = io::SliceRange{first, last}});
  };
  const int last = geometry.dimensions.z - 1;
  if (plan.slices.last < plan.slices.first) {
    leave_out(0, last);
  } else {
    leave_out(0, plan.slices.first - 1);
    leave_out(plan.slices.last + 1, last);
  }
}

}  // namespace palpate::modes
