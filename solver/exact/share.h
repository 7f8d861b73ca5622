#pragma once

/// The forces of primitives that meet at one point. Their sum is a point of the sum of their force bodies.

#include <cstdint>
#include <span>

#include "solver/exact/placed.h"

namespace palpate::solver::internal {

/// Where a primitive's force lies in its force body.
enum class ForceRegion : std::uint8_t {
  idle,  ///< zero: a plane that the proxy would leave at its front
  held,  ///< strictly inside
  full   ///< at its full strength
};

/// The point of the force body nearest to `force`; `hold` receives where it lies.
Vec3 project(const Placed& primitive, const Vec3& force, ForceRegion& hold);

/// Forces of the primitives with these indices, each inside its force body, whose sum is as near to `wanted` as
/// possible. Returns the missing force, N: zero if it is no more than `tolerance` and rounding.
///
/// The least change of the forces from zero has the form F_i = projection of p onto body i, with one p for all. p is
/// found by a semismooth Newton method (L. Qi, J. Sun, 1993). A small term keeps p bounded, so the search is repeated
/// once or twice from the forces found (the proximal point method, R. T. Rockafellar, 1976).
Vec3 share_out(std::span<const Placed> primitives, std::span<const std::uint32_t> which, const Vec3& wanted,
               double tolerance, std::span<Vec3> forces, std::span<ForceRegion> hold);

}  // namespace palpate::solver::internal
