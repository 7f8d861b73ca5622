#pragma once

/// The paper's numerical solver, section 4: steepest descent from the previous proxy. It is kept as printed, as the
/// reference for the other solvers. It can cycle forever and can freeze millimeters away from the proxy.

#include <limits>
#include <span>

#include "solver/solver_type.h"

namespace palpate::solver {

struct DescentOptions {
  double first_step = 1e-3;                                       ///< m: l of equation (22) at the start
  double reduction = 0.7;                                         ///< the factor for l when equation (23) holds
  double turn = std::numeric_limits<double>::epsilon();           ///< N^2: the right side of equation (23)
  double smallest_step = std::numeric_limits<double>::epsilon();  ///< m: the loop ends when l is below it
  int max_iterations = 10000;                                     ///< after that many: Outcome::capped
};

/// forces: one for each primitive; the force functions' values at the proxy found, N. They are zero on a constraint, so
/// if a constraint holds the proxy, the error bound is true but loose: about the missing force / k.
///
/// Outcome::unsuitable if a strength is infinite. The balance has to be one that validate() accepts. No allocation.
Solution solve_descent(const Balance& balance, const DescentOptions& options, std::span<Vec3> forces) noexcept;

extern const SolverType descent_solver;

}  // namespace palpate::solver
