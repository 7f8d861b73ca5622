#pragma once

/// The slack law of certify.h in coordinates relative to the probe.

#include <span>

#include "palpate/solver/internal/flat.h"
#include "palpate/solver/internal/placed.h"

namespace palpate::solver::internal {

/// What a primitive contributes to the law at a point: an admissible force and its slack.
struct Share {
  Vec3 force{0};              ///< N
  double force_error = 0;     ///< N: rounding of the force
  double slack = 0;           ///< J
  double backward_slack = 0;  ///< J: what is left of it when the primitive may move by the rounding of its data
  bool held = false;          ///< the force is one that only a point on the primitive exerts
};

/// The cheaper of the full force at z (no slack) and the admissible force nearest to `force` (with its slack).
/// doubt: how far z may be from the point meant, m.
Share share_of(const Placed& primitive, const FineVec3& z, const Vec3& force, double stiffness, double doubt = 0);

struct Bound {
  double error = 0;           ///< m, rounded outwards
  double backward_error = 0;  ///< m: the same for the nearest balance within the rounding of the data
  double residual = 0;        ///< N
  double slack = 0;           ///< J
};

/// The law at the exact point of the flat that z stands for. forces: as many as primitives.
Bound bound_at(const PlacedPrimitives& primitives, double stiffness, const FineVec3& z, const Flat& flat,
               std::span<const Vec3> forces);

/// An answer relative to the probe with the bound of its error.
struct Settled {
  FineVec3 z;
  Bound bound;
};

/// Settles z onto what holds it there, if that is near, and bounds the error of the point found.
Settled settle_and_bound(const PlacedPrimitives& primitives, double stiffness, const FineVec3& z,
                         std::span<const Vec3> forces);

}  // namespace palpate::solver::internal
