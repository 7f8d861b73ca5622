#include "io/fields/cell.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "io/padding.h"

namespace palpate::io::internal {
namespace {

/// Whether a corner that has a weight is padding.
template <typename Stored>
bool weighs_padding(const Volume& volume, const std::vector<Stored>& voxels, const Cell& cell) noexcept {
  if (!volume.padding && std::is_integral_v<Stored>) return false;
  const StoredPadding<Stored> padding(volume);
  const Stored* const first = voxels.data() + volume.offset(cell.first.x, cell.first.y, cell.first.z);
  const std::size_t row = volume.offset(0, 1, 0), slice = volume.offset(0, 0, 1);
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      const Stored* const two = first + (k != 0 ? slice : 0) + (j != 0 ? row : 0);
      for (int i = 0; i < cell.size.x; ++i) {
        if (padding(two[i]) != 0 && cell.weight(i, j, k) > 0) return true;
      }
    }
  }
  return false;
}

}  // namespace

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
  return std::visit([&](const auto& voxels) { return !weighs_padding(volume, voxels, cell); }, volume.voxels);
}

namespace {

/// The sum over a cell of eight numbers, in the same order as below; corners without weight add nothing.
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
    // For floats only if all corners have a weight: a corner without one may be NaN.
    const auto within = [](double fraction) { return fraction > 0 && fraction < 1; };
    if (cell.size == glm::ivec3(2)) {
      if (std::is_integral_v<typename std::decay_t<decltype(voxels)>::value_type> ||
          (within(cell.fraction.x) && within(cell.fraction.y) && within(cell.fraction.z))) {
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
