#pragma once

/// Which forces primitives that meet at one point exert there: a point of the sum of their force bodies.

#include <cstdint>
#include <span>

#include "solver/exact/placed.h"

namespace palpate::solver::internal {

/// Where in its force body the force of a primitive is.
enum class ForceRegion : std::uint8_t {
  idle,  ///< nothing: a plane before which the proxy would be
  held,  ///< strictly inside
  full   ///< its whole strength
};

/// The point of the force body nearest to `force`; hold tells where it is.
Vec3 project(const Placed& primitive, const Vec3& force, ForceRegion& hold);

/// Forces of the primitives whose indices are given, each inside its force body, that together come as near to `wanted`
/// as they can. Returns what is missing, N: nothing, where that is no more than `tolerance` and rounding.
///
/// The least change of the forces from zero has the form F_i = projection of p onto body i, with one p for all; p is
/// found by a semismooth Newton method (L. Qi, J. Sun, 1993), and the same once or twice more from the forces found,
/// for p is held back a little to have it bounded (the proximal point method, R. T. Rockafellar, 1976).
Vec3 share_out(std::span<const Placed> primitives, std::span<const std::uint32_t> which, const Vec3& wanted,
               double tolerance, std::span<Vec3> forces, std::span<ForceRegion> hold);

}  // namespace palpate::solver::internal
