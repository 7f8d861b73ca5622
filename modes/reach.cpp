#include "palpate/modes/reach.h"

#include <algorithm>
#include <limits>

namespace palpate::modes {
namespace {

/// A slice and the device's box are both convex: an axis of the box that has all four corners beyond one end separates
/// them.
bool is_out_of_reach(const io::Geometry& geometry, int slice, const Workspace& workspace, const Vec3& half_extent_m) {
  Vec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
  for (const double i : {0.0, geometry.dimensions.x - 1.0}) {
    for (const double j : {0.0, geometry.dimensions.y - 1.0}) {
      const Vec3 corner = workspace.to_device(geometry.to_patient({i, j, slice}));
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], corner[axis]);
        high[axis] = std::max(high[axis], corner[axis]);
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] > half_extent_m[axis] || high[axis] < -half_extent_m[axis]) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::pair<int, int>> slices_out_of_reach(const io::Geometry& geometry, const Workspace& workspace,
                                                     const Vec3& half_extent_m) {
  std::vector<std::pair<int, int>> runs;
  for (int slice = 0; slice < geometry.dimensions.z; ++slice) {
    if (!is_out_of_reach(geometry, slice, workspace, half_extent_m)) {
      continue;
    }
    if (!runs.empty() && runs.back().second == slice - 1) {
      runs.back().second = slice;
    } else {
      runs.emplace_back(slice, slice);
    }
  }
  return runs;
}

}  // namespace palpate::modes
