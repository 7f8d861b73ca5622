#pragma once

/// A slow solver in 128-bit arithmetic, as a reference in tests and benchmarks. It shares neither method nor code with
/// the others. Not for the tick.

#include "solver/balance.h"

namespace palpate::solver {

/// The exact proxy.
struct Reference {
  Vec3 offset{0};     ///< m: from the probe to the proxy, rounded to double
  Vec3 rest{0};       ///< m: the remainder of that rounding
  double radius = 0;  ///< m: the exact proxy is within this distance; infinity if none was found
  int iterations = 0;
};

/// Smooths every norm in the energy to sqrt(|m|^2 + mu^2) and follows its minimum to mu = 0 by a primal-dual Newton
/// method (K. D. Andersen, E. Christiansen, A. R. Conn, M. L. Overton, An efficient primal-dual interior-point method
/// for minimizing a sum of Euclidean norms, SIAM J. Sci. Comput. 22, 2000; a plane is half a norm in one dimension).
/// The radius is the law of certify.h in 128 bits; the doubles of the balance count as exact. Hard constraints get a
/// strength larger than the force they need.
///
/// The balance has to be one that validate() accepts, and its hard constraints have a common point. Allocates.
Reference solve_reference(const Balance& balance);

/// How far a proxy is from the reference, m.
double distance_to(const Reference& reference, const Balance& balance, const Vec3& proxy);

}  // namespace palpate::solver
