#pragma once

/// A certificate for an answer. It needs neither a solver nor a reference: the balance, a proxy and the primitives'
/// forces give a bound on the distance to the exact proxy.

#include <span>

#include "solver/balance.h"

namespace palpate::solver {

/// For any forces F_i that the primitives can exert (their force bodies), with r = |k (x - probe) - sum F_i| and
/// eps = sum of phi_i(x) - F_i . (x_i - x), where phi_i is the primitive's term of the energy, strong convexity gives
/// |x - x*| <= (r + sqrt(r^2 + 4 k eps)) / (2 k).
struct Certificate {
  double error_bound = 0;  ///< m: |proxy - exact proxy| is at most this; rounded outwards
  /// m: the same for the most favorable balance within 4 ulp of the data. If constraints are redundant except for
  /// rounding, error_bound is true but loose; this one says whether the answer is as exact as the data allow.
  double backward_bound = 0;
  double residual = 0;  ///< N: r, where the bound was evaluated
  double slack = 0;     ///< J: eps, where the bound was evaluated
};

/// The law above, evaluated in double-double: at the point nearest to the proxy on the flat that holds it (a rounded
/// proxy is never exactly on a plane), with the distance to that point added. If the bound at the proxy itself is
/// smaller, it is taken.
///
/// forces: one for each primitive, N. A force outside its primitive's force body is replaced by the nearest one inside.
/// So any forces give a true bound, and accurate forces a tight one. A hard constraint that the proxy misses adds its
/// distance to the bound. If the constraints that hold the proxy and the hard ones have no common point, those missed
/// by at most hard_tolerance are moved until they have one, and the bound is that of the moved balance. If one is
/// missed by more, the bound is infinite. The balance must be one that validate() accepts. O(n), no allocation.
Certificate certify(const Balance& balance, const Vec3& proxy, std::span<const Vec3> forces) noexcept;

/// The largest error that counts as exact, m. Every solver here keeps within it if the balance is well conditioned:
/// 1e-14 m + 16 ulp of the coordinates (of the probe and of the primitives that act) and of the distance |sum of the
/// forces| / k.
double promised_accuracy(const Balance& balance, const Vec3& proxy, std::span<const Vec3> forces) noexcept;

/// A hard constraint (infinite strength) counts as met by a point whose distance from it is below this fraction of L.
/// L is the largest distance from the probe to the proxy or to the position of a hard constraint.
inline constexpr double hard_tolerance = 1e-12;

}  // namespace palpate::solver
