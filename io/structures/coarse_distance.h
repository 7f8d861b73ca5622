#pragma once

/// The distance far from a surface, on a coarse lattice.

#include <vector>

#include "io/structures/closest_points.h"

namespace palpate::io {

/// A lattice along the patient's axes.
struct CoarseLattice {
  Vec3 origin{0};
  double spacing = 1;  ///< mm
  glm::ivec3 size{0};  ///< nodes

  std::size_t count() const noexcept {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }
};

/// A lattice over a box, with a spacing that balances interpolation error and memory.
CoarseLattice coarse_lattice(const Vec3& low_mm, const Vec3& high_mm);

/// For each node the closest of some points (patient space, mm), passed from neighbor to neighbor; `nowhere` if there
/// are no points.
std::vector<Vec3f> closest_of(const CoarseLattice& coarse, const std::vector<Vec3f>& points);

/// Signed distances of its nodes, mm, from the closest points of the bricks' nodes, passed from neighbor to neighbor
/// (Danielsson 1980). The sign of `f` gives the side of the bricks' nodes.
std::vector<float> coarse_distances(const CoarseLattice& coarse, const NodeBricks& bricks, const std::vector<float>& f,
                                    const std::vector<Vec3f>& closest);

}  // namespace palpate::io
