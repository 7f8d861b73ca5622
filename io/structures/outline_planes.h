#pragma once

/// What an outline says, plane by plane: of every node of a plane how far it is, within the plane, from what is inside
/// and from what is outside. Labels (label_planes.h) and contours (contour_planes.h) are both read so.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "io/structures/node_bricks.h"

namespace palpate::io {

/// Of one plane, rows of nodes one after the other: squared, mm^2, in the plane; `far` where there is nothing within
/// the band.
struct PlaneDistances {
  static constexpr float far = 1e12F;

  std::vector<float> to_inside;
  std::vector<float> to_outside;
  /// Where the outline itself says how far a node is from the edge (fractions): mm, positive inside; NaN elsewhere.
  /// Empty where it never does.
  std::vector<float> known;
};

struct OutlinePlanes {
  NodeLattice lattice;
  std::vector<int> node;  ///< of each plane, ascending: which node along the third axis it lies on
  /// How far the surface may be from the nearest point that is known to be on its other side, mm.
  double play_mm = 1;
  /// How far from the surface the field has to reach, mm.
  double band_mm = 3;
  /// Computes one plane. From any thread.
  std::function<void(std::size_t plane, PlaneDistances& distances)> compute;
};

/// mm: over how far the field goes over from full detail to the coarse lattice.
inline double blend_mm(const NodeLattice& lattice) {
  return std::max(2.0, 2.0 * glm::length(lattice.spacing));
}

/// The band that a reach of the field needs.
inline double band_for(double reach_mm, const NodeLattice& lattice, double play_mm) {
  const double cell_mm = glm::length(lattice.spacing);
  return std::max(reach_mm + blend_mm(lattice), play_mm) + 1.5 * cell_mm;
}

}  // namespace palpate::io
