#pragma once

/// Moves a point near the flat that holds the proxy onto that flat, and bounds the error there.

#include <span>

#include "solver/exact/active_set.h"
#include "solver/exact/bound.h"

namespace palpate::solver::internal {

/// An answer relative to the probe with the bound of its error.
struct Settled {
  FineVec3 z;
  Bound bound;
};

/// Settles z onto the flat of the locked primitives.
Settled settle_on(const ActiveSet& active, std::span<const Placed> placed, double stiffness, const FineVec3& z,
                  std::span<const Vec3> forces);

/// Settles z onto the flat that its forces indicate, if that flat is near.
Settled settle_and_bound(const PlacedPrimitives& primitives, double stiffness, const FineVec3& z,
                         std::span<const Vec3> forces);

}  // namespace palpate::solver::internal
