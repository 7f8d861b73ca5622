#pragma once

/// Labels of bodies given by a formula, on all types of grids.

#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "io/structures/mask.h"

namespace palpate::io {

using InsideOf = std::function<bool(const Vec3&)>;

struct LabelLattice {
  Vec3 spacing{1};
  glm::dmat3 axes{1};         ///< columns: unit, at right angles
  double tilt_per_slice = 0;  ///< mm along the second axis
  double unevenness = 0;      ///< fraction of a step by which every second slice is nearer to the one before
};

/// The labels of a body around the origin, within `extent` of it.
inline Mask made_labels(const InsideOf& inside, double extent, const LabelLattice& lattice = {}) {
  Mask mask;
  Geometry& geometry = mask.geometry;
  const Vec3& h = lattice.spacing;
  geometry.direction_i = lattice.axes[0];
  geometry.direction_j = lattice.axes[1];
  geometry.spacing_i = h.x;
  geometry.spacing_j = h.y;
  geometry.dimensions = glm::ivec3(glm::ceil(2.0 * extent / h));
  geometry.step = h.z * lattice.axes[2] + lattice.tilt_per_slice * lattice.axes[1];
  geometry.uniform = lattice.unevenness == 0;
  const Vec3 first = -0.5 * Vec3(geometry.dimensions - 1) * h;
  for (int k = 0; k < geometry.dimensions.z; ++k) {
    const double height = (k - (k % 2 != 0 ? lattice.unevenness : 0)) * h.z;
    const double slide = (k - geometry.dimensions.z / 2) * lattice.tilt_per_slice;
    geometry.slice_positions.push_back(lattice.axes * (first + Vec3(0, slide, height)));
  }
  mask.size = geometry.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        mask.occupancy.push_back(inside(geometry.to_patient({i, j, k})) ? Mask::full : 0);
      }
    }
  }
  return mask;
}

}  // namespace palpate::io
