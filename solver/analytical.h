#pragma once

/// The analytical solver, section 3.1: one pass of proxy movements, from the probe through the directed forces (12),
/// the planes (13), the lines (14, 15) and the points (16). Each movement is the proximal map of its primitive.

#include <span>

#include "solver/solver_type.h"

namespace palpate::solver {

/// Planes of one direction, parallel lines and points that coincide are merged. Their strengths add up, and each takes
/// a part of the force in proportion to its strength. If some are hard, they share the force equally and the others
/// take none.
///
/// One pass is exact if, at its end, every primitive can still exert the force that its movement stands for. The
/// certificate checks this. The answer is accepted if its error, for data within 4 ulp of those given, is at most
/// promised_accuracy(); otherwise the outcome is Outcome::unsuitable. The configurations of section 3.1 are always
/// accepted: co-located constraints, with planes that are orthogonal, opposed or merged, and lines that are merged and
/// along or across every plane's normal. Others are accepted if no movement disturbs another.
///
/// forces: one for each primitive; its force on the proxy, N. The balance has to be one that validate() accepts. No
/// allocation; O(n) for any number of primitives that merge into at most 16. iterations is the number of movements.
Solution solve_analytical(const Balance& balance, std::span<Vec3> forces) noexcept;

extern const SolverType analytical_solver;

}  // namespace palpate::solver
