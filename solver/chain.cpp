#include "solver/chain.h"

#include <algorithm>

#include "solver/analytical.h"

namespace palpate::solver {

namespace {

// m: far below what a hand or a device can tell, far above what rounding does to a bound.
constexpr double unfelt = 1e-9;

Solution solve_in_order(const Balance& balance, const ChainOptions& options, ExactScratch& scratch,
                        std::span<const Vec3> last_forces, std::span<Vec3> forces) {
  Solution solution;
  if (options.analytical) {
    solution = solve_analytical(balance, forces);
    if (solution.outcome == Outcome::solved) {
      return solution;
    }
    if (!options.exact && !options.descent && solution.error_bound > 0 && solution.error_bound <= unfelt) {
      // The others were left out because this one solves the configuration; rounding has loosened the bound.
      solution.outcome = Outcome::capped;
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

Chain::Chain(const ChainOptions& options) : options_(options), scratch_(options.exact ? options.capacity : 0) {
  last_forces_.reserve(options.capacity);
  last_primitives_.reserve(options.capacity);
}

std::size_t Chain::memory_bytes() const noexcept {
  return scratch_.memory_bytes() + last_forces_.capacity() * sizeof(Vec3) +
         last_primitives_.capacity() * sizeof(Primitive);
}

void Chain::forget() noexcept {
  last_forces_.clear();
  last_solution_.outcome = Outcome::unsuitable;
}

bool Chain::is_last(const Balance& balance) const noexcept {
  const auto same = [](const Primitive& a, const Primitive& b) {
    return a.type == b.type && a.strength == b.strength && a.position == b.position && a.direction == b.direction;
  };
  return last_solution_.outcome == Outcome::solved && balance.stiffness == last_.stiffness &&
         balance.probe == last_.probe &&
         (last_solution_.solver != SolverKind::descent || balance.previous_proxy == last_.previous_proxy) &&
         std::equal(balance.primitives.begin(), balance.primitives.end(), last_primitives_.begin(),
                    last_primitives_.end(), same);
}

void Chain::remember(const Balance& balance, const Solution& solution, std::span<const Vec3> forces) noexcept {
  last_forces_.assign(forces.begin(), forces.end());
  last_primitives_.assign(balance.primitives.begin(), balance.primitives.end());
  last_ = {balance.stiffness, balance.probe, balance.previous_proxy, {}};
  last_solution_ = solution;
}

Solution Chain::solve(const Balance& balance, std::span<Vec3> forces) noexcept {
  if (const auto rejection = validate(balance)) {
    Solution refused;
    refused.outcome = Outcome::refused;
    refused.rejection = rejection;
    return refused;
  }
  if (options_.warm_start && is_last(balance)) {
    std::copy(last_forces_.begin(), last_forces_.end(), forces.begin());
    return last_solution_;
  }
  const Solution solution = solve_in_order(balance, options_, scratch_, last_forces_, forces);
  if (solution.outcome == Outcome::solved || solution.outcome == Outcome::capped) {
    remember(balance, solution, forces);
  } else {
    forget();
  }
  return solution;
}

}  // namespace palpate::solver
