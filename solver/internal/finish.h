#pragma once

/// The smooth problem that is left when it is known which primitives hold the proxy: see exact.h.

#include <cstdint>
#include <span>

#include "palpate/solver/internal/bound.h"
#include "palpate/solver/internal/multipliers.h"

namespace palpate::solver::internal {

/// From the minimum of the envelopes, state.next and state.hold: puts the proxy on the flat of the held primitives,
/// solves the rest by Newton's method, shares the force that the flat exerts among them, and bounds the error. forces:
/// out, N. held: scratch, as long as primitives. The answer can be wrong; its bound is not.
Settled finish(const Multipliers& state, const PlacedPrimitives& primitives, std::span<std::uint32_t> held,
               std::span<Vec3> forces);

}  // namespace palpate::solver::internal
