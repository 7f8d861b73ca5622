#include "plugin/paraview/common/even_copy.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <type_traits>
#include <variant>
#include <vector>

namespace palpate::plugin {
namespace {

struct Corner {
  glm::ivec3 offset{0};
  double weight = 0;
};

/// The voxels around an index and their weights; those without weight left out. The lattice shares the slices'
/// directions, so one set serves a whole slice.
std::vector<Corner> corners_about(const glm::dvec3& fraction) {
  std::vector<Corner> corners;
  for (const int k : {0, 1}) {
    for (const int j : {0, 1}) {
      for (const int i : {0, 1}) {
        const double weight =
            (i ? fraction.x : 1 - fraction.x) * (j ? fraction.y : 1 - fraction.y) * (k ? fraction.z : 1 - fraction.z);
        if (weight > 0) corners.push_back({{i, j, k}, weight});
      }
    }
  }
  return corners;
}

bool has_slices_at(const io::Geometry& geometry, double k) {
  const double below = std::floor(k);
  const bool in_gap = k != below && std::ranges::binary_search(geometry.gaps, static_cast<int>(below));
  return k >= 0 && k <= geometry.dimensions.z - 1 && !in_gap;
}

template <typename Stored>
Stored in_type(double value) {
  return static_cast<Stored>(std::is_integral_v<Stored> ? std::round(value) : value);
}

glm::dvec3 near_whole(glm::dvec3 index) {
  constexpr double seen = 1e-3;  // of a voxel: not worth blending for
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(index[axis] - std::round(index[axis])) < seen) index[axis] = std::round(index[axis]);
  }
  return index;
}

template <typename Stored>
class EvenCopy {
 public:
  EvenCopy(const io::Volume& volume, const std::vector<Stored>& voxels)
      : volume_(volume), voxels_(voxels), outside_(*std::min_element(voxels.begin(), voxels.end())) {}

  /// One slice of the lattice; `start` is the scan's continuous index of the lattice's (0, 0, k).
  Stored* fill(const glm::dvec3& start, const std::array<int, 6>& extent, Stored* out) const {
    const glm::dvec3 floor = glm::floor(start);
    const glm::ivec3 base(floor);
    const auto corners = corners_about(start - floor);
    const bool imaged = has_slices_at(volume_.geometry, start.z);
    for (int j = extent[2]; j <= extent[3]; ++j) {
      for (int i = extent[0]; i <= extent[1]; ++i) {
        *out++ = imaged ? blend(base + glm::ivec3(i, j, 0), corners) : outside_;
      }
    }
    return out;
  }

 private:
  Stored blend(const glm::ivec3& at, const std::vector<Corner>& corners) const {
    const glm::ivec3& size = volume_.geometry.dimensions;
    double value = 0;
    for (const Corner& corner : corners) {
      const glm::ivec3 p = at + corner.offset;
      const bool inside = glm::all(glm::greaterThanEqual(p, glm::ivec3(0))) && glm::all(glm::lessThan(p, size));
      value += corner.weight * (inside ? voxels_[volume_.offset(p.x, p.y, p.z)] : outside_);
    }
    return in_type<Stored>(value);
  }

  const io::Volume& volume_;
  const std::vector<Stored>& voxels_;
  Stored outside_;
};

}  // namespace

void copy_evenly(const io::Volume& volume, const DisplayGrid& grid, const std::array<int, 6>& extent,
                 vtkDataArray& array) {
  std::visit(
      [&](const auto& voxels) {
        using Stored = typename std::decay_t<decltype(voxels)>::value_type;
        const EvenCopy<Stored> copy(volume, voxels);
        auto* out = static_cast<Stored*>(array.GetVoidPointer(0));
        for (int k = extent[4]; k <= extent[5]; ++k) {
          const glm::dvec3 position = grid.origin_mm + k * grid.spacing_mm[2] * grid.direction_k;
          const glm::dvec3 index = near_whole(volume.geometry.to_index(position));
          out = copy.fill(index, extent, out);
        }
      },
      volume.voxels);
}

}  // namespace palpate::plugin
