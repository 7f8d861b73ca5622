#include "palpate/solver/exact.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "palpate/solver/certify.h"
#include "palpate/solver/internal/answer.h"
#include "palpate/solver/internal/finish.h"

namespace palpate::solver {

using internal::Hold;
using internal::Placed;

struct ExactScratch::Arrays {
  std::vector<Placed> placed;
  std::vector<Vec3> forces;
  std::vector<Vec3> next;
  std::vector<Vec3> best;
  std::vector<Hold> hold;
  std::vector<std::uint32_t> held;

  void fit(std::size_t n) {
    if (placed.size() < n) {
      placed.resize(n);
      forces.resize(n);
      next.resize(n);
      best.resize(n);
      hold.resize(n);
      held.resize(n);
    }
  }
};

ExactScratch::ExactScratch(std::size_t capacity) : arrays_(std::make_unique<Arrays>()) {
  arrays_->fit(capacity);
}
ExactScratch::~ExactScratch() = default;
ExactScratch::ExactScratch(ExactScratch&&) noexcept = default;
ExactScratch& ExactScratch::operator=(ExactScratch&&) noexcept = default;

Solution solve_exact(const Balance& balance, std::span<Vec3> forces, ExactScratch& scratch, Start start,
                     const ExactOptions& options) noexcept {
  const std::size_t n = balance.primitives.size();
  ExactScratch::Arrays& arrays = scratch.arrays();
  arrays.fit(n);
  const std::span<Placed> placed = std::span(arrays.placed).first(n);
  internal::Multipliers state;
  state.primitives = placed;
  state.stiffness = balance.stiffness;
  state.forces = std::span(arrays.forces).first(n);
  state.next = std::span(arrays.next).first(n);
  state.hold = std::span(arrays.hold).first(n);
  for (std::size_t i = 0; i < n; ++i) {
    placed[i] = internal::place(balance.primitives[i], balance.probe);
    state.forces[i] = state.next[i] = Vec3{0};
    if (placed[i].type == PrimitiveType::directed_force) {
      state.pull += placed[i].direction * placed[i].strength;
    }
  }
  const internal::PlacedPrimitives primitives =
      n > 0 ? internal::PlacedPrimitives(placed) : internal::PlacedPrimitives(balance.primitives, balance.probe);

  if (start == Start::warm) {
    state.z = state.pull / state.stiffness;
    for (std::size_t i = 0; i < n; ++i) {
      if (placed[i].type != PrimitiveType::directed_force) {
        state.forces[i] = internal::project(placed[i], forces[i], state.hold[i]);
        state.z += state.forces[i] / state.stiffness;
      }
    }
  } else {
    internal::sweep(state);
  }
  Solution solution;
  solution.solver = SolverKind::exact;
  solution.outcome = Outcome::capped;
  internal::Settled best{};
  bool any = false;
  state.sigma = 100 * state.stiffness;
  int round = 0;
  while (true) {
    solution.iterations += internal::minimise(state, options.max_iterations - solution.iterations);
    const internal::Settled settled =
        internal::finish(state, primitives, std::span(arrays.held).first(n), std::span(arrays.best).first(n));
    if (!any || settled.bound.error < best.bound.error) {
      any = true;
      best = settled;
      std::copy_n(arrays.best.begin(), n, forces.begin());
      internal::write_answer(balance, best, solution);
    }
    if (best.bound.backward_error <= promised_accuracy(balance, solution.proxy, forces)) {
      solution.outcome = Outcome::solved;
      break;
    }
    if (solution.iterations >= options.max_iterations) {
      break;
    }
    if (round == 0 && start == Start::cold) {
      std::fill(state.forces.begin(), state.forces.end(), Vec3{0});
    } else {
      std::copy(state.next.begin(), state.next.end(), state.forces.begin());
    }
    if (state.sigma < 1e10 * state.stiffness) {
      state.sigma *= 30;
    }
    if (++round > 40) {
      break;
    }
  }
  return solution;
}

}  // namespace palpate::solver
