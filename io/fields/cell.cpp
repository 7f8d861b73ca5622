#include "io/fields/cell.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

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

namespace {

/// The sum over a cell of eight whole numbers, in the same order as below: what has no weight adds nothing.
template <typename Stored>
double sum_of_eight(const Stored* first, std::size_t row, std::size_t slice, const Cell& cell) noexcept {
  double sum = 0;
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      const Stored* const two = first + (k != 0 ? slice : 0) + (j != 0 ? row : 0);
      sum += cell.weight(0, j, k) * static_cast<double>(two[0]);
      sum += cell.weight(1, j, k) * static_cast<double>(two[1]);
    }
  }
  return sum;
}

}  // namespace

double trilinear_value(const Volume& volume, const Cell& cell) noexcept {
  const auto stored = [&](const auto& voxels) {
    if constexpr (std::is_integral_v<typename std::decay_t<decltype(voxels)>::value_type>) {
      if (cell.size == glm::ivec3(2)) {
        return sum_of_eight(voxels.data() + volume.offset(cell.first.x, cell.first.y, cell.first.z),
                            volume.offset(0, 1, 0), volume.offset(0, 0, 1), cell);
      }
    }
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
