#pragma once

/// Many primitives in columns, so that the compiler can process several at once. Used for the effects of primitives so
/// far from z that no double-double is needed.

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
  std::vector<double> qx, qy, qz;                    ///< direction; zero for a point
  std::vector<double> strength;
  std::vector<double> size;  ///< size_of(offset)

  void fit(std::size_t n);
  void take(std::span<const Placed> sorted);
  std::size_t memory_bytes() const noexcept;
};

/// The sums of primitives' effects at a point, as in Local.
struct Sums {
  Vec3 force{0};         ///< N
  Symmetric3 hessian{};  ///< N/m
  double size = 0;       ///< N
  double noise = 0;      ///< N
};

/// Adds the effects of the planes, lines and points far enough from z, and writes their forces. Writes the indices of
/// the others, and of the locked ones, to `near`, and returns their number. coarseness: as in Walk; touch: m.
std::size_t add_far(const Columns& columns, const FineVec3& z, const ActiveSet& active, double coarseness, double touch,
                    Sums& sums, std::span<Vec3> forces, std::span<std::uint32_t> near);

}  // namespace palpate::solver::internal
