#pragma once

/// An outline, plane by plane. Each node of a plane has its distances, within the plane, to the nearest inside and to
/// the nearest outside. Labels (label_planes.h) and contours (contour_planes.h) both become this.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "io/structures/node_bricks.h"

namespace palpate::io {

/// The squared distances of one plane, mm^2, row by row and measured in the plane; `far` if there is none within the
/// band.
struct PlaneDistances {
  static constexpr float far = 1e12F;

  std::vector<float> to_inside;
  std::vector<float> to_outside;
  /// The distance of a node from the edge if the outline itself gives it (fractions): mm, positive inside; NaN
  /// elsewhere. Empty if the outline never gives it.
  std::vector<float> known;
};

struct OutlinePlanes {
  NodeLattice lattice;
  std::vector<int> node;  ///< of each plane, ascending: its node along the third axis
  /// The lattice of every 2^coarser-th node along each axis still contains all planes, and almost no node between them.
  int coarser = 0;
  /// The largest possible distance of the surface from the nearest point that is known to be on its other side, mm.
  double play_mm = 1;
  /// The distance from the surface up to which the field must be computed, mm.
  double band_mm = 3;
  /// Computes one plane. From any thread.
  std::function<void(std::size_t plane, PlaneDistances& distances)> compute;
};

/// mm: the distance over which the field changes from full detail to the coarse lattice.
inline double blend_mm(const NodeLattice& lattice) {
  return std::max(2.0, 2.0 * glm::length(lattice.spacing));
}

/// The width of the band that a field with this reach needs.
inline double band_for(double reach_mm, const NodeLattice& lattice, double play_mm) {
  const double cell_mm = glm::length(lattice.spacing);
  return std::max(reach_mm + blend_mm(lattice), play_mm) + 1.5 * cell_mm;
}

}  // namespace palpate::io
