#include "io/fields/cell.h"

#include <algorithm>
#include <cmath>

namespace palpate::io::internal {

bool find_cell(const Volume& volume, const Vec3& index, Cell& cell) noexcept {
  const Geometry& g = volume.geometry;
  if (!g.contains(index)) {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int last = std::max(g.dimensions[axis] - 2, 0);
    cell.first[axis] = std::min(static_cast<int>(index[axis]), last);
    cell.size[axis] = std::min(g.dimensions[axis], 2);
    cell.fraction[axis] = index[axis] - cell.first[axis];
  }
  if (cell.fraction.z > 0 && cell.fraction.z < 1 && std::binary_search(g.gaps.begin(), g.gaps.end(), cell.first.z)) {
    return false;
  }
  const bool may_be_float = std::holds_alternative<std::vector<float>>(volume.voxels);
  if (!volume.padding && !may_be_float) {
    return true;
  }
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      for (int i = 0; i < cell.size.x; ++i) {
        const glm::ivec3 v = cell.first + glm::ivec3(i, j, k);
        if (cell.weight(i, j, k) > 0 &&
            (volume.is_padding(v.x, v.y, v.z) || !std::isfinite(volume.value_at(v.x, v.y, v.z)))) {
          return false;
        }
      }
    }
  }
  return true;
}

double trilinear_value(const Volume& volume, const Cell& cell) noexcept {
  const auto stored = [&](const auto& voxels) {
    double sum = 0;
    for (int k = 0; k < cell.size.z; ++k) {
      for (int j = 0; j < cell.size.y; ++j) {
        for (int i = 0; i < cell.size.x; ++i) {
          const double weight = cell.weight(i, j, k);
          if (weight > 0) {  // beside the cell there may be padding that is no number
            const glm::ivec3 v = cell.first + glm::ivec3(i, j, k);
            sum += weight * static_cast<double>(voxels[volume.offset(v.x, v.y, v.z)]);
          }
        }
      }
    }
    return sum;
  };
  return volume.slope * std::visit(stored, volume.voxels) + volume.intercept;
}

}  // namespace palpate::io::internal
