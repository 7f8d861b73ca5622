/// Every family by every solver, over 256 seeded balances each; and what keeping out of structures costs.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "solver/chain.h"
#include "solver/exact.h"
#include "solver/testing/problems.h"

namespace palpate::solver {
namespace {

constexpr std::uint64_t seeds = 256;

struct Case {
  Problem problem;
  std::vector<Vec3> start;   ///< forces of the tick before, whose probe was 0.05 mm away
  std::vector<Vec3> forces;  ///< of the tick
};

std::vector<Case> cases_of(Family family, ExactScratch& scratch) {
  std::vector<Case> cases;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Case each{make_problem(family, seed), {}, {}};
    each.start.resize(each.problem.primitives.size());
    each.forces.resize(each.problem.primitives.size());
    Balance before = each.problem.balance();
    before.probe += Vec3(3e-5, -4e-5, 0);
    solve_exact(before, each.start, scratch);
    cases.push_back(std::move(each));
  }
  return cases;
}

void run(benchmark::State& state, const SolverType& type, Start start) {
  const Family family = all_families[static_cast<std::size_t>(state.range(0))];
  state.SetLabel(name_of(family));
  ExactScratch of_start(128);
  std::vector<Case> cases = cases_of(family, of_start);
  const std::unique_ptr<Scratch> scratch = type.make_scratch == nullptr ? nullptr : type.make_scratch(128);
  std::size_t next = 0;
  for (auto _ : state) {
    Case& each = cases[next++ % cases.size()];
    if (start == Start::warm) std::copy(each.start.begin(), each.start.end(), each.forces.begin());
    Solution solution = type.solve(each.problem.balance(), each.forces, scratch.get(), {.start = start});
    benchmark::DoNotOptimize(solution);
  }
  state.SetItemsProcessed(state.iterations());
}

/// Balances of a walk into a wall that is kept out of over 3 mm and out again, with friction: a force and a plane for
/// each of `structures`, which all lie in the same place.
std::vector<Problem> walk_into(std::int64_t structures) {
  constexpr int steps = 600;
  const Vec3 outward = glm::normalize(Vec3(1, 0.2, -0.1));
  Chain chain;
  std::vector<Problem> walk;
  std::vector<Vec3> forces;
  Vec3 proxy(0.005, 0, 0);
  for (int n = 0; n < 2 * steps; ++n) {
    const double x = 0.005 - 0.015 * (n < steps ? n : 2 * steps - n) / steps;
    Problem tick{.probe = {x, 0, 0}, .previous_proxy = proxy, .primitives = {make_point(0.1, proxy)}};
    const double t = std::clamp(1 - glm::dot(proxy, outward) / 0.003, 0.0, 1.0);
    const double part = t * t * (3 - 2 * t);
    for (std::int64_t of = 0; of < structures && part > 0; ++of) {
      tick.primitives.push_back(make_directed_force(0.4 * part, outward));
      tick.primitives.push_back(make_plane(1.6 * part, proxy, outward));
    }
    forces.resize(tick.primitives.size());
    proxy = chain.solve(tick.balance(), forces).proxy;
    walk.push_back(std::move(tick));
  }
  return walk;
}

void keep_out(benchmark::State& state) {
  const std::vector<Problem> walk = walk_into(state.range(0));
  Chain chain;
  std::vector<Vec3> forces(1 + 2 * static_cast<std::size_t>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) {
    const Problem& tick = walk[next++ % walk.size()];
    Solution solution = chain.solve(tick.balance(), std::span(forces).first(tick.primitives.size()));
    benchmark::DoNotOptimize(solution);
  }
}

constexpr auto last = static_cast<std::int64_t>(std::size(all_families)) - 1;
static_assert(all_families[last] == Family::many);

[[maybe_unused]] const bool registered = [] {
  for (const SolverType* const type : solver_types()) {
    const std::string name(type->name);
    // Of `many` descent takes 10 000 steps each, and has no answer.
    const std::int64_t most = last - (type->reads_previous_proxy ? 1 : 0);
    const auto add = [&](const std::string& called, Start start) {
      benchmark::RegisterBenchmark(called.c_str(), run, std::cref(*type), start)
          ->DenseRange(0, most)
          ->Unit(benchmark::kMicrosecond);
    };
    add(type->reads_forces ? name + "_cold" : name, Start::cold);
    if (type->reads_forces) add(name + "_warm", Start::warm);
  }
  return true;
}();

BENCHMARK(keep_out)->DenseRange(0, 5);

}  // namespace
}  // namespace palpate::solver
