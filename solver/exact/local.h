#pragma once

/// The energy and its derivatives at one point, as a walk reads them.

#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/exact/active_set.h"
#include "solver/exact/columns.h"
#include "solver/exact/placed.h"
#include "solver/exact/share.h"
#include "solver/exact/symmetric.h"

namespace palpate::solver::internal {

/// A balance relative to the probe, and the present place of a walk down its energy.
struct Walk {
  std::span<const Placed> primitives;  ///< of finite strengths
  const Columns* columns = nullptr;    ///< the same, sorted by kind; null for most_unsorted and fewer
  double stiffness = 0;                ///< k, N/m
  Vec3 pull{0};                        ///< the sum of the directed forces, N
  double coarseness = 0;               ///< a primitive counts as met within this part of the distances from the probe
  FineVec3 z;                          ///< m
  ActiveSet active;                    ///< the locked primitives
  bool arrived = false;                ///< out: whether the walk is at the minimum, as far as it can tell
  std::span<Vec3> forces;              ///< N: each primitive's force on the proxy, at its last evaluation
  std::span<ForceRegion> hold;         ///< scratch
  std::span<std::uint32_t> met;        ///< scratch
};

/// More primitives than this are sorted and evaluated in columns. No tick has more (modes::most_primitives), so
/// recordings keep their bits.
inline constexpr std::size_t most_unsorted = 128;

struct Local {
  Vec3 gradient{0};      ///< N, of all primitives that are not met
  Symmetric3 hessian{};  ///< N/m, of the same primitives
  double size = 0;       ///< N: the sum of the magnitudes of the gradient's terms
  double noise = 0;      ///< N: the largest error of the gradient from the rounding of z
  std::size_t met = 0;   ///< number of primitives that z is on, locked or not: their indices are the first in Walk::met
};

/// At z, with these primitives locked. Writes walk.forces (of those that are not met) and walk.met.
Local evaluate(const Walk& walk, const FineVec3& z, const ActiveSet& active);

/// dE/dt at the point evaluated last, along a direction that the locked primitives allow. A primitive that z lies on
/// counts with its force after the step. N m, of a direction in m.
double slope(const Walk& walk, const Local& local, const ActiveSet& active, const FineVec3& way);

/// How fast a plane's depth grows along a direction.
double rate_of(const Placed& plane, const FineVec3& way);

/// How fast a movement in this direction leaves a line or point.
double speed_across(const Placed& attractor, const Vec3& way);

/// Newton's step within the flat.
Vec3 newton_step(const ActiveSet& active, const Local& local, double stiffness);

}  // namespace palpate::solver::internal
