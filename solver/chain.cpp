#include "solver/chain.h"

#include <algorithm>

namespace palpate::solver {

namespace {

// m: far below what a hand or a device can tell, far above what rounding does to a bound.
constexpr double unfelt = 1e-9;

}  // namespace

Chain::Chain(const ChainOptions& options) : options_(options) {
  for (const SolverType* type : solver_types()) {
    if (options.solvers.contains(*type)) {
      members_.push_back({type, type->make_scratch == nullptr ? nullptr : type->make_scratch(options.capacity)});
    }
  }
  last_forces_.reserve(options.capacity);
  last_primitives_.reserve(options.capacity);
}

Solution Chain::solve_in_order(const Balance& balance, std::span<Vec3> forces) const noexcept {
  const bool is_warm = options_.warm_start && !forces.empty() && last_forces_.size() == forces.size();
  Solution solution;
  for (const auto& [type, scratch] : members_) {
    RunOptions options{.max_iterations = options_.max_iterations};
    if (is_warm && type->reads_forces) {
      std::copy(last_forces_.begin(), last_forces_.end(), forces.begin());
      options.start = Start::warm;
    }
    solution = type->solve(balance, forces, scratch.get(), options);
    if (solution.outcome == Outcome::solved || solution.outcome == Outcome::refused) {
      return solution;
    }
  }
  if (solution.outcome == Outcome::unsuitable && solution.error_bound > 0 && solution.error_bound <= unfelt) {
    // The later solvers were left out because this one solves the configuration. Rounding has loosened its bound.
    solution.outcome = Outcome::capped;
  }
  return solution;
}

std::size_t Chain::memory_bytes() const noexcept {
  std::size_t bytes = members_.capacity() * sizeof(Member) + last_forces_.capacity() * sizeof(Vec3) +
                      last_primitives_.capacity() * sizeof(Primitive);
  for (const Member& member : members_) {
    bytes += member.scratch ? member.scratch->memory_bytes() : 0;
  }
  return bytes;
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
         (!last_solution_.solver->reads_previous_proxy || balance.previous_proxy == last_.previous_proxy) &&
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
  const Solution solution = solve_in_order(balance, forces);
  if (solution.outcome == Outcome::solved || solution.outcome == Outcome::capped) {
    remember(balance, solution, forces);
  }
  return solution;
}

}  // namespace palpate::solver
