#pragma once

/// The method of multipliers with a semismooth Newton method: see exact.h.

#include <cstdint>
#include <span>

#include "palpate/solver/internal/placed.h"
#include "palpate/solver/internal/symmetric.h"

namespace palpate::solver::internal {

/// What a primitive does to the proxy.
enum class Hold : std::uint8_t {
  idle,  ///< nothing: a plane before which the proxy is
  held,  ///< its force is strictly inside the force body: the proxy is on it
  full   ///< its whole strength
};

/// The state of the method: all relative to the probe.
struct Multipliers {
  std::span<const Placed> primitives;
  double stiffness = 0;    ///< k, N/m
  Vec3 pull{0};            ///< the sum of the directed forces, N
  double sigma = 0;        ///< of the envelopes, N/m
  Vec3 z{0};               ///< m
  std::span<Vec3> forces;  ///< F_i, N, each inside its force body
  std::span<Vec3> next;    ///< scratch: the envelopes' forces at z
  std::span<Hold> hold;    ///< where in its body each of `next` is
};

/// The point of the force body nearest to `force`; hold tells where it is.
Vec3 project(const Placed& primitive, const Vec3& force, Hold& hold);

/// The same, and adds its derivative with respect to `force`, times scale, to `derivative`.
Vec3 project(const Placed& primitive, const Vec3& force, Hold& hold, double scale, Symmetric3& derivative);

/// One sweep of proximal steps from z = pull / k: the analytical solver without its conditions. A good start.
void sweep(Multipliers& state);

/// Minimises the sum of envelopes from z; then next and hold are those of the minimum. Returns the Newton steps taken,
/// at most `cap`.
int minimise(Multipliers& state, int cap);

}  // namespace palpate::solver::internal
