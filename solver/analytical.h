#pragma once

/// The analytical solver, section 3.1: one pass of proxy movements, from the probe through the directed forces (12),
/// the planes (13), the lines (14, 15) and the points (16). Each movement is the proximal map of its primitive.

#include <span>

#include "solver/solution.h"

namespace palpate::solver {

/// Co-directional planes, parallel lines and points that coincide are merged: their strengths add, and each has its
/// share of the force in proportion to its strength (the hard ones alone, in equal parts, where there are any).
///
/// One pass is exact where each force that a movement stands for is one that its primitive still exerts where the pass
/// ends. That is judged there, by the certificate: the answer is accepted where the error that it may have, for data
/// within 4 ulp of those given, is at most promised_accuracy(); otherwise Outcome::unsuitable. The configurations of
/// section 3.1 always pass: co-located constraints, planes orthogonal or opposed or merged, lines merged and along or
/// across every plane's normal. Others pass where one movement happens not to disturb another.
///
/// forces: as many as primitives; each one's force on the proxy, N. The balance has to be one that validate() accepts.
/// No allocation; O(n) for any number of primitives that merge into at most 16. iterations is the number of movements.
Solution solve_analytical(const Balance& balance, std::span<Vec3> forces) noexcept;

}  // namespace palpate::solver
