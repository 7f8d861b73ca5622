#pragma once

/// The flat (a plane, line or point) on which up to three independent primitives keep a proxy. It is in double-double,
/// so that it is accurate even if the primitives are nearly parallel.

#include <cstdint>
#include <span>

#include "solver/exact/placed.h"

namespace palpate::solver::internal {

/// The locked primitives: none; a point; a line and perhaps a plane that it crosses; or one to three planes.
struct ActiveSet {
  int count = 0;  ///< locked primitives
  int rank = 0;   ///< directions that they fix: 3 for a point, 2 for a line, 1 for a plane
  std::uint32_t locked[3];
  FineVec3 normal[3];  ///< of length one, each orthogonal to the normals of the planes (and line) before it
  /// for each normal: the component along it of its primitive's direction, which is the sine of an angle
  double size[3];
  FineVec3 along;  ///< the free direction, of length one, if rank is 2

  bool has(std::size_t i) const {
    return (count > 0 && locked[0] == i) || (count > 1 && locked[1] == i) || (count > 2 && locked[2] == i);
  }
};

/// Locks primitive i too. Returns false and changes nothing if it depends on the locked ones or its type cannot be
/// locked with them.
bool lock(ActiveSet& active, std::span<const Placed> primitives, std::uint32_t i);

/// The same set without the j-th locked primitive.
ActiveSet without(const ActiveSet& active, std::span<const Placed> primitives, int j);

/// Moves z onto the flat.
void settle(const ActiveSet& active, std::span<const Placed> primitives, FineVec3& z);

/// How far the exact flat may be from z, m, after settle().
double doubt_of(const ActiveSet& active, std::span<const Placed> primitives, const FineVec3& z);

/// The part of v within the flat.
FineVec3 within(const ActiveSet& active, const FineVec3& v);

/// Forces of the locked primitives, of any size, whose sum is the part of `needed` normal to the flat.
void share(const ActiveSet& active, std::span<const Placed> primitives, const Vec3& needed, Vec3 (&forces)[3]);

}  // namespace palpate::solver::internal
