#pragma once

/// The flat (a point, line or plane) on which the primitives that hold a proxy keep it.

#include <cstdint>
#include <span>

#include "palpate/solver/internal/placed.h"

namespace palpate::solver::internal {

struct Flat {
  Vec3 normal[3];           ///< orthonormal: the first `rank` of them are fixed
  int rank = 0;             ///< 0: free, 3: a point
  std::uint32_t chosen[3];  ///< the independent primitives that make the flat
  int count = 0;            ///< how many of them
  double doubt = 0;         ///< m: the exact flat passes z within this distance

  bool has_chosen(std::size_t i) const;
};

/// Moves z (relative to the probe) onto the primitives whose indices are given, as far as they are independent: a
/// point, else a line and what else is independent of it, else up to three planes, the least parallel first.
Flat settle(const PlacedPrimitives& primitives, std::span<const std::uint32_t> held, FineVec3& z);

}  // namespace palpate::solver::internal
