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
  /// Fills the forces with what the solver starts from; not timed.
  std::function<void(const solver::Problem&, std::span<solver::Vec3> forces)> prepare;
  std::function<solver::Solution(const solver::Balance&, std::span<solver::Vec3> forces)> solve;
  bool scales = false;      ///< worth trying on thousands of primitives
  bool is_variant = false;  ///< of a solver that is in the list already
};

/// Every type of solver, those that can start warm cold and warm (from the forces of a tick whose probe was 0.05 mm
/// away, 50 mm/s at 1 kHz); descent with two other settings; Nelder and Mead's simplex (1965), the paper's named
/// alternative, if the program was built with NLopt.
std::vector<Entrant> solver_entrants();

struct NamedSolvers {
  std::string name;
  solver::SolverSet solvers;
};

/// Those that a haptic loop can run with: the usual chain, and each solver alone that solves balances of any kind.
std::vector<NamedSolvers> solvers_to_compare();

/// What a solver did in the wind tunnel: potential flow past a sphere (testdata/flow.h).
struct WindTunnelResult {
  std::size_t declined = 0;
  double mean_us = 0;
  std::size_t free = 0;           ///< ticks in which no constraint held the proxy
  double mean_residual_m = 0;     ///< of those, equation (7) over k
  double largest_residual_m = 0;  ///< of those
};

/// The paper's test (section 5): a probe on a winding way at 50 mm/s and 1 kHz, with the follow and the force mode's
/// primitives at the proxy of the tick before and, with `surface`, a plane along the pressure's gradient.
WindTunnelResult walk_through_wind_tunnel(const Entrant& entrant, bool surface, int ticks);

}  // namespace palpate::plugin
