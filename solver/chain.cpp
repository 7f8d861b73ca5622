#include "palpate/solver/chain.h"

#include "palpate/solver/analytical.h"

namespace palpate::solver {

Chain::Chain(const ChainOptions& options) : options_(options) {}

Solution Chain::solve(const Balance& balance, std::span<Vec3> forces) noexcept {
  if (const auto rejection = validate(balance)) {
    Solution refused;
    refused.outcome = Outcome::refused;
    refused.rejection = rejection;
    return refused;
  }
  Solution solution;
  if (options_.analytical) {
    solution = solve_analytical(balance, forces);
    if (solution.outcome == Outcome::solved) {
      return solution;
    }
  }
  if (options_.descent) {
    solution = solve_descent(balance, options_.descent_options, forces);
  }
  return solution;
}

}  // namespace palpate::solver
