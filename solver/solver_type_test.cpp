/// Laws of every solver in the list: a new one is tested here by being there.

#include "solver/solver_type.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "solver/analytical.h"
#include "solver/certify.h"
#include "solver/chain.h"
#include "solver/descent.h"
#include "solver/exact.h"
#include "solver/testing/problems.h"
#include "solver/testing/reference.h"

namespace palpate::solver {
namespace {

TEST(SolverType, EachHasANameANumberAndASummaryOfItsOwn) {
  std::set<std::string_view> names, summaries;
  std::set<int> numbers;
  for (const SolverType* const type : solver_types()) {
    EXPECT_TRUE(names.insert(type->name).second) << type->name;
    EXPECT_TRUE(summaries.insert(type->summary).second) << type->name;
    EXPECT_TRUE(numbers.insert(type->number).second) << type->name;
    EXPECT_TRUE(type->number >= 1 && type->number <= 63) << type->name;
    EXPECT_FALSE(type->name.empty() || type->summary.empty());
    EXPECT_NE(type->name, name_of(nullptr));
    EXPECT_EQ(find_solver_type(type->name), type);
    EXPECT_EQ(solver_of_number(number_of(type)), type);
    EXPECT_EQ(name_of(type), type->name);
  }
  EXPECT_EQ(find_solver_type("none"), nullptr);
  EXPECT_EQ(solver_of_number(0), nullptr);
  EXPECT_EQ(solver_of_number(4000000000), nullptr);
  EXPECT_EQ(number_of(nullptr), 0U);
}

/// Of recordings that exist: the numbers are never given to others.
TEST(SolverType, NumbersStay) {
  EXPECT_EQ(analytical_solver.number, 1);
  EXPECT_EQ(exact_solver.number, 2);
  EXPECT_EQ(descent_solver.number, 3);
}

/// An answer is the solver's own, within its bound of the exact proxy, and its forces add up to the coupling's.
TEST(SolverType, EveryAnswerIsWithinItsBound) {
  for (const SolverType* const type : solver_types()) {
    int answers = 0, known = 0;
    for (const Family family : all_families) {
      if (family == Family::many) continue;
      for (std::uint64_t seed = 0; seed < 6; ++seed) {
        const Problem problem = make_problem(family, seed);
        const Balance balance = problem.balance();
        std::vector<Vec3> forces(problem.primitives.size(), Vec3(std::numeric_limits<double>::quiet_NaN()));
        const std::unique_ptr<Scratch> scratch = type->make_scratch ? type->make_scratch(forces.size()) : nullptr;
        const Solution solution = type->solve(balance, forces, scratch.get(), {});
        if (solution.outcome != Outcome::solved && solution.outcome != Outcome::capped) continue;
        ++answers;
        EXPECT_EQ(solution.solver, type);
        for (const Vec3& force : forces) EXPECT_TRUE(std::isfinite(glm::length(force))) << type->name;
        const Reference reference = solve_reference(balance);
        if (!(reference.radius < 0.1 * solution.error_bound)) continue;
        ++known;
        EXPECT_LE(distance_to(reference, balance, solution.proxy), 1.1 * solution.error_bound)
            << type->name << ", " << name_of(family) << " " << seed;
      }
    }
    EXPECT_GT(answers, 0) << type->name;
    EXPECT_GT(known, 0) << type->name;
  }
}

/// What a type says of itself is so: without a scratch it needs none, and cold it reads neither forces nor, unless it
/// says so, the previous proxy.
TEST(SolverType, ReadsOnlyWhatItSaysItReads) {
  for (const SolverType* const type : solver_types()) {
    for (const Family family : {Family::allowed, Family::co_located, Family::spread}) {
      const Problem problem = make_problem(family, 3);
      const std::unique_ptr<Scratch> scratch = type->make_scratch ? type->make_scratch(64) : nullptr;
      const auto solve = [&](const Vec3& away, double force, Start start) {
        std::vector<Vec3> forces(problem.primitives.size(), Vec3(force));
        Balance balance = problem.balance();
        balance.previous_proxy += away;
        return type->solve(balance, forces, scratch.get(), {.start = start});
      };
      const Solution first = solve(Vec3(0), 0, Start::cold);
      EXPECT_EQ(solve(Vec3(0), 0.3, Start::cold).proxy, first.proxy) << type->name;
      const Solution from_elsewhere = solve(Vec3(type->reads_previous_proxy ? 0 : 1e-3), 0, Start::cold);
      EXPECT_EQ(from_elsewhere.proxy, first.proxy) << type->name;
      const Solution warm = solve(Vec3(0), 0.3, type->reads_forces ? Start::cold : Start::warm);
      EXPECT_EQ(warm.proxy, first.proxy) << type->name;
    }
  }
}

/// Of every set, and one that is in it already too.
TEST(SolverType, ASetWithOneMoreHasAllThatItHadAndThatOne) {
  const auto types = solver_types();
  for (unsigned in = 0; in < 1U << types.size(); ++in) {
    SolverSet set;
    for (std::size_t n = 0; n < types.size(); ++n) set.set(*types[n], (in >> n & 1U) != 0);
    for (const SolverType* const more : types) {
      const SolverSet both = set.with(*more);
      for (std::size_t n = 0; n < types.size(); ++n) {
        const bool was_in = (in >> n & 1U) != 0;
        EXPECT_EQ(both.contains(*types[n]), was_in || types[n] == more) << in << " with " << more->name;
        EXPECT_EQ(set.contains(*types[n]), was_in) << "the set itself stays as it is";
      }
    }
  }
}

TEST(SolverType, AChainAsksInTheOrderOfTheList) {
  for (const SolverType* const alone : solver_types()) {
    EXPECT_EQ(SolverSet::usual().contains(*alone), alone->is_usual);
    SolverSet set{alone};
    for (const SolverType* const type : solver_types()) EXPECT_EQ(set.contains(*type), type == alone);
    EXPECT_FALSE(set.is_empty());
    set.set(*alone, false);
    EXPECT_TRUE(set.is_empty());
  }
  // What every solver solves: the first of those that are on answers.
  const std::vector<Primitive> force{make_directed_force(1, {0, 1, 0})};
  for (std::size_t first = 0; first < solver_types().size(); ++first) {
    SolverSet set;
    for (const SolverType* const type : solver_types().subspan(first)) set.set(*type);
    Chain chain({.solvers = set});
    std::vector<Vec3> forces(1);
    EXPECT_EQ(chain.solve({400, {0, -1e-3, 0}, Vec3{0}, force}, forces).solver, solver_types()[first]);
  }
}

}  // namespace
}  // namespace palpate::solver
