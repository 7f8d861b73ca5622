#pragma once

/// Many primitives side by side, so that the compiler can look at several at once: what those do that are far enough
/// from z to need no double-double.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/exact/active_set.h"
#include "solver/exact/placed.h"
#include "solver/exact/symmetric.h"

namespace palpate::solver::internal {

/// Sorted by kind: directed forces, planes, lines, points.
struct Columns {
  std::size_t planes = 0;                            ///< the first plane
  std::size_t attractors = 0;                        ///< the first line or point
  std::vector<double> x, y, z, x_low, y_low, z_low;  ///< offset, in double-double
  std::vector<double> qx, qy, qz;                    ///< direction; zero of a point
  std::vector<double> strength;
  std::vector<double> size;  ///< size_of(offset)

  void fit(std::size_t n);
  void take(std::span<const Placed> sorted);
  std::size_t memory_bytes() const noexcept;
};

/// What primitives do at a point, as in Local.
struct Sums {
  Vec3 force{0};         ///< N
  Symmetric3 hessian{};  ///< N/m
  double size = 0;       ///< N
  double noise = 0;      ///< N
};

/// Adds what planes, lines and points do that are far enough from z, and writes their forces. Writes the indices of
/// the others, and of what is locked, to `near`, and returns how many these are. coarseness: as in Walk; touch: m.
std::size_t add_far(const Columns& columns, const FineVec3& z, const ActiveSet& active, double coarseness, double touch,
                    Sums& sums, std::span<Vec3> forces, std::span<std::uint32_t> near);

}  // namespace palpate::solver::internal
