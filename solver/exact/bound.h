#pragma once

/// The slack law of certify.h in coordinates relative to the probe.

#include <cstdint>
#include <span>

#include "solver/exact/placed.h"

namespace palpate::solver::internal {

/// A primitive's contribution to the law at a point: an admissible force and its slack. Not initialized by default:
/// short arrays of these are kept on the stack.
struct Contribution {
  Vec3 force;             ///< N
  double force_error;     ///< N: rounding of the force
  double slack;           ///< J
  double backward_slack;  ///< J: the slack that remains if the primitive may move by the rounding of its data
  bool held;              ///< whether the primitive exerts this force only on a point that lies on it
};

/// The full force at z (no slack) or the admissible force nearest to `force` (with its slack), whichever gives the
/// smaller bound. doubt: how far z may be from the exact point, m.
Contribution share_of(const Placed& primitive, const FineVec3& z, const Vec3& force, double stiffness, double doubt = 0,
                      bool leniently = false);

/// A flat that holds the proxy: its primitives, and how far the exact flat may be from the point used for it.
struct Flat {
  int count = 0;
  std::uint32_t chosen[3];
  double doubt = 0;  ///< m

  bool has(std::size_t i) const {
    return (count > 0 && chosen[0] == i) || (count > 1 && chosen[1] == i) || (count > 2 && chosen[2] == i);
  }
};

struct Bound {
  double error = 0;           ///< m, rounded outwards
  double backward_error = 0;  ///< m: the same for the nearest balance within the rounding of the data
  double residual = 0;        ///< N
  double slack = 0;           ///< J
};

/// The law at the exact point of the flat that z approximates. forces: one for each primitive. leniently: hard
/// constraints count as met within hard_tolerance.
Bound bound_at(const PlacedPrimitives& primitives, double stiffness, const FineVec3& z, const Flat& flat,
               std::span<const Vec3> forces, bool leniently = false);

/// The same at z itself, if no flat holds the proxy; `shares` are those of share_of() at z.
Bound bound_of(std::span<const Contribution> shares, double stiffness, const FineVec3& z);

}  // namespace palpate::solver::internal
