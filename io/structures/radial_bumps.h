#pragma once

/// The sum that a trace adds to a field: sum c_i w(|x - p_i| / R), w = (1-r)^4 (4r+1) (Wendland; edits.h).

#include <cstdint>
#include <span>
#include <vector>

#include "io/structures/node_bricks.h"

namespace palpate::io::internal {

struct RadialBumps {
  std::vector<Vec3> at;        ///< p_i
  std::vector<double> weight;  ///< c_i
  double reach_mm = 1;         ///< R
};

/// w; 0 from r = 1 on.
double wendland(double r) noexcept;

/// The sum of the bumps `which` at a place.
double sum_of(const RadialBumps& bumps, std::span<const std::uint32_t> which, const Vec3& place) noexcept;

/// Adds the sum at each node of a brick to `sums`, in the order of NodeBricks::at(). It is exactly 0 beyond the
/// reach.
void add_at_nodes(const RadialBumps& bumps, std::span<const std::uint32_t> which, const NodeLattice& lattice,
                  const glm::ivec3& brick, std::span<double, brick_nodes> sums) noexcept;

}  // namespace palpate::io::internal
