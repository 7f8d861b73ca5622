#pragma once

/// The solvers that `palpate bench solvers` compares.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "palpate/solver/problems.h"
#include "palpate/solver/solution.h"

namespace palpate::plugin {

struct Entrant {
  std::string name;
  /// Fills the forces with what the solver starts from; not timed.
  std::function<void(const solver::Problem&, std::span<solver::Vec3> forces)> prepare;
  std::function<solver::Solution(const solver::Balance&, std::span<solver::Vec3> forces)> solve;
};

/// Analytical; exact, cold and warm (from the forces of a frame whose probe was 0.05 mm away, 50 mm/s at 1 kHz);
/// descent with the paper's settings and two others; Nelder and Mead's simplex (1965), the paper's named alternative,
/// where the program was built with NLopt.
std::vector<Entrant> solver_entrants();

}  // namespace palpate::plugin
