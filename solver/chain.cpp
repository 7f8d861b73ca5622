#include "palpate/solver/chain.h"

#include <algorithm>

#include "palpate/solver/analytical.h"

namespace palpate::solver {

namespace {

Solution solve_in_order(const Balance& balance, const ChainOptions& options, ExactScratch& scratch,
                        std::span<const Vec3> last_forces, std::span<Vec3> forces) {
  Solution solution;
  if (options.analytical) {
    solution = solve_analytical(balance, forces);
    if (solution.outcome == Outcome::solved) {
      return solution;
    }
  }
  if (options.exact) {
    const bool warm = options.warm_start && !forces.empty() && last_forces.size() == forces.size();
    if (warm) {
      std::copy(last_forces.begin(), last_forces.end(), forces.begin());
    }
    solution = solve_exact(balance, forces, scratch, warm ? Start::warm : Start::cold, options.exact_options);
    if (solution.outcome == Outcome::solved || solution.outcome == Outcome::refused || !options.descent) {
      return solution;
    }
  }
  if (options.descent) {
    solution = solve_descent(balance, options.descent_options, forces);
  }
  return solution;
}

}  // namespace

Chain::Chain(const ChainOptions& options) : options_(options), scratch_(options.capacity) {
  last_forces_.reserve(options.capacity);
}

Solution Chain::solve(const Balance& balance, std::span<Vec3> forces) noexcept {
  if (const auto rejection = validate(balance)) {
    Solution refused;
    refused.outcome = Outcome::refused;
    refused.rejection = rejection;
    return refused;
  }
  const Solution solution = solve_in_order(balance, options_, scratch_, last_forces_, forces);
  if (solution.outcome == Outcome::solved || solution.outcome == Outcome::capped) {
    last_forces_.assign(forces.begin(), forces.end());
  } else {
    last_forces_.clear();
  }
  return solution;
}

}  // namespace palpate::solver
