/// Every family by every solver, over 256 seeded balances each.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "palpate/solver/analytical.h"
#include "palpate/solver/descent.h"
#include "palpate/solver/exact.h"
#include "palpate/solver/problems.h"

namespace palpate::solver {
namespace {

constexpr std::uint64_t seeds = 256;

struct Case {
  Problem problem;
  std::vector<Vec3> start;   ///< forces of the frame before, whose probe was 0.05 mm away
  std::vector<Vec3> forces;  ///< of the frame
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

template <typename Solve>
void run(benchmark::State& state, Family family, const Solve& solve) {
  ExactScratch scratch(128);
  std::vector<Case> cases = cases_of(family, scratch);
  std::size_t next = 0;
  for (auto _ : state) {
    Case& each = cases[next++ % cases.size()];
    Solution solution = solve(each, scratch);
    benchmark::DoNotOptimize(solution);
  }
  state.SetItemsProcessed(state.iterations());
}

Solution analytically(Case& each, ExactScratch&) {
  return solve_analytical(each.problem.balance(), each.forces);
}
Solution exactly_cold(Case& each, ExactScratch& scratch) {
  return solve_exact(each.problem.balance(), each.forces, scratch);
}
Solution exactly_warm(Case& each, ExactScratch& scratch) {
  std::copy(each.start.begin(), each.start.end(), each.forces.begin());
  return solve_exact(each.problem.balance(), each.forces, scratch, Start::warm);
}
Solution by_descent(Case& each, ExactScratch&) {
  return solve_descent(each.problem.balance(), {}, each.forces);
}

const bool registered = [] {
  for (const Family family : all_families) {
    const auto add = [family](const char* solver, auto solve) {
      benchmark::RegisterBenchmark((std::string(name_of(family)) + "/" + solver).c_str(), [family, solve](
                                                                                              benchmark::State& state) {
        run(state, family, solve);
      })->Unit(benchmark::kMicrosecond);
    };
    add("analytical", analytically);
    add("exact_cold", exactly_cold);
    add("exact_warm", exactly_warm);
    if (family != Family::many) {  // 10 000 steps each, and no answer
      add("descent", by_descent);
    }
  }
  return true;
}();

}  // namespace
}  // namespace palpate::solver
