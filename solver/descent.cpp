#include "solver/descent.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "solver/certify.h"
#include "solver/exact/placed.h"

namespace palpate::solver {

Solution solve_descent(const Balance& balance, const DescentOptions& options, std::span<Vec3> forces) noexcept {
  Solution solution;
  solution.solver = &descent_solver;
  for (const Primitive& primitive : balance.primitives) {
    if (std::isinf(primitive.strength)) {
      return solution;
    }
  }

  Vec3 x = balance.previous_proxy;
  Vec3 last_residual{0};
  double step = options.first_step;
  solution.outcome = Outcome::solved;
  while (step >= options.smallest_step) {
    const Vec3 epsilon = residual(balance, x);
    const double size = internal::length_of(epsilon);
    if (size == 0) {
      break;
    }
    if (solution.iterations > 0 && glm::dot(epsilon, last_residual) < options.turn) {
      step *= options.reduction;
    }
    if (solution.iterations == options.max_iterations) {
      solution.outcome = Outcome::capped;
      break;
    }
    x += epsilon * (step / size);
    last_residual = epsilon;
    ++solution.iterations;
  }

  solution.proxy = x;
  for (std::size_t i = 0; i < balance.primitives.size(); ++i) {
    forces[i] = force_on(balance.primitives[i], x);
  }
  solution.error_bound = certify(balance, x, forces).error_bound;
  return solution;
}

const SolverType descent_solver{
    .name = "descent",
    .number = 3,
    .summary = "the paper's numerical solver, kept as the reference: no hard constraints, off by millimeters at worst",
    .reads_previous_proxy = true,
    .solve = [](const Balance& balance, std::span<Vec3> forces, Scratch*, const RunOptions& options) noexcept {
      DescentOptions own;
      if (options.max_iterations > 0) {
        own.max_iterations = options.max_iterations;
      }
      return solve_descent(balance, own, forces);
    }};

}  // namespace palpate::solver
