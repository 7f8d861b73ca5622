#pragma once

/// The voxels around a point and their trilinear weights.

#include "io/volume.h"

namespace palpate::io::internal {

struct Cell {
  glm::ivec3 first{0};  ///< lowest corner
  glm::ivec3 size{0};   ///< corners along each axis: 2, or 1 along an axis of one voxel
  Vec3 fraction{0};     ///< 0 ... 1 from the lowest corner to the next

  /// Weight of the corner first + (i, j, k); those of all corners add up to 1.
  double weight(int i, int j, int k) const noexcept {
    return (i != 0 ? fraction.x : 1 - fraction.x) * (j != 0 ? fraction.y : 1 - fraction.y) *
           (k != 0 ? fraction.z : 1 - fraction.z);
  }
};

/// The cell that holds a continuous index. False if nothing can be sampled there: outside the box of the voxel
/// centers, in a gap of missing slices, or where a corner whose weight is not zero is padding.
bool find_cell(const Volume& volume, const Vec3& index, Cell& cell) noexcept;

/// The rescaled value in a cell.
double trilinear_value(const Volume& volume, const Cell& cell) noexcept;

}  // namespace palpate::io::internal
