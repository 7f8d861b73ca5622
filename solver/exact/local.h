#pragma once

/// What the energy does about one point: everything that a walk looks at.

#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/exact/active_set.h"
#include "solver/exact/columns.h"
#include "solver/exact/placed.h"
#include "solver/exact/share.h"
#include "solver/exact/symmetric.h"

namespace palpate::solver::internal {

/// A balance relative to the probe, and where a walk down its energy is.
struct Walk {
  std::span<const Placed> primitives;  ///< of finite strengths
  const Columns* columns = nullptr;    ///< the same, sorted by kind; null of most_unsorted and fewer
  double stiffness = 0;                ///< k, N/m
  Vec3 pull{0};                        ///< the sum of the directed forces, N
  double coarseness = 0;               ///< of what counts as met, relative to the distances from the probe
  FineVec3 z;                          ///< m
  ActiveSet active;                    ///< what is locked
  bool arrived = false;                ///< out: at the minimum, as far as this walk can tell
  std::span<Vec3> forces;              ///< N: each primitive's force on the proxy, where it was looked at last
  std::span<ForceRegion> hold;         ///< scratch
  std::span<std::uint32_t> met;        ///< scratch
};

/// More primitives than this are sorted and looked at side by side. No tick has more (modes::most_primitives), so what
/// was recorded keeps its bits.
inline constexpr std::size_t most_unsorted = 128;

struct Local {
  Vec3 gradient{0};      ///< N, of all that is not met
  Symmetric3 hessian{};  ///< N/m, of the same
  double size = 0;       ///< N: the sum of the magnitudes that the gradient is made of
  double noise = 0;      ///< N: how wrong the gradient may be by the rounding of z
  std::size_t met = 0;   ///< primitives that z is on, locked or not: their indices are the first in Walk::met
};

/// At z, with these locked. Writes walk.forces (of what is not met) and walk.met.
Local look(const Walk& walk, const FineVec3& z, const ActiveSet& active);

/// dE/dt at the point evaluated last, along a direction that the locked primitives allow. A primitive that z lies on
/// counts as it will after the step. N m, of a direction in m.
double slope(const Walk& walk, const Local& local, const ActiveSet& active, const FineVec3& way);

/// How fast a plane's depth grows along a way.
double rate_of(const Placed& plane, const FineVec3& way);

/// How fast a way leaves an attractor.
double speed_across(const Placed& attractor, const Vec3& way);

/// Newton's step within the flat.
Vec3 newton_step(const ActiveSet& active, const Local& local, double stiffness);

}  // namespace palpate::solver::internal
