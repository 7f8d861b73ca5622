#pragma once

/// The solvers that `palpate-bench solvers` compares.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "solver/solver_type.h"
#include "solver/testing/problems.h"

namespace palpate::plugin {

struct Entrant {
  std::string name;
  const solver::SolverType* type = nullptr;  ///< null: no solver of ours
  /// Fills the forces with the solver's starting values; not timed.
  std::function<void(const solver::Problem&, std::span<solver::Vec3> forces)> prepare;
  std::function<solver::Solution(const solver::Balance&, std::span<solver::Vec3> forces)> solve;
  bool scales = false;      ///< whether to try it on thousands of primitives
  bool is_variant = false;  ///< of a solver that is already in the list
};

/// Every type of solver; those that support warm starts both cold and warm (from the forces of a tick with the probe
/// 0.05 mm away, 50 mm/s at 1 kHz); descent with two other settings; the simplex of Nelder and Mead (1965), which the
/// paper names as an alternative, if the program was built with NLopt.
std::vector<Entrant> solver_entrants();

struct NamedSolvers {
  std::string name;
  solver::SolverSet solvers;
};

/// Solvers usable in a haptic loop: the usual chain, and each solver alone that solves balances of any type.
std::vector<NamedSolvers> solvers_to_compare();

/// The results of a solver in the wind tunnel: potential flow past a sphere (testdata/flow.h).
struct WindTunnelResult {
  std::size_t declined = 0;
  double mean_us = 0;
  std::size_t free = 0;           ///< ticks in which no constraint held the proxy
  double mean_residual_m = 0;     ///< of these ticks, equation (7) over k
  double largest_residual_m = 0;  ///< of those
};

/// The paper's test (section 5): a probe on a winding path at 50 mm/s and 1 kHz, with the primitives of the follow and
/// the force mode at the proxy of the previous tick and, with `surface`, a plane along the pressure's gradient.
WindTunnelResult walk_through_wind_tunnel(const Entrant& entrant, bool surface, int ticks);

}  // namespace palpate::plugin
