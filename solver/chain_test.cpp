#include "solver/chain.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <new>

#include "solver/analytical.h"
#include "solver/descent.h"
#include "solver/exact.h"
#include "solver/testing/problems.h"
#include "solver/testing/values.h"

namespace {

std::atomic<bool> trap{false};
std::atomic<int> trapped{0};

void* allocate(std::size_t size) {
  if (trap) {
    ++trapped;
  }
  if (void* memory = std::malloc(size > 0 ? size : 1)) {
    return memory;
  }
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size);
}
void* operator new[](std::size_t size) {
  return allocate(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace palpate::solver {
namespace {

const SolverType* solver_of(const ChainOptions& options, std::span<const Primitive> primitives) {
  Chain chain(options);
  std::vector<Vec3> forces(primitives.size());
  return chain.solve({400, {-mm, -2 * mm, 0}, Vec3{0}, primitives}, forces).solver;
}

TEST(Chain, TheFirstThatCanDoesAndTheOthersMayBeOff) {
  const std::array orthogonal{make_plane(1, Vec3{0}, {0, 1, 0})};
  const std::array oblique{make_plane(3, Vec3{0}, {1, 0, 0}), make_plane(3, Vec3{0}, {0.6, 0.8, 0})};
  EXPECT_EQ(solver_of({}, orthogonal), &analytical_solver);
  EXPECT_EQ(solver_of({}, oblique), &exact_solver);
  EXPECT_EQ(solver_of({.solvers = {&exact_solver}}, orthogonal), &exact_solver);
  const ChainOptions without_exact{.solvers = {&descent_solver, &analytical_solver}};
  EXPECT_EQ(solver_of(without_exact, oblique), &descent_solver);
  EXPECT_EQ(solver_of(without_exact, orthogonal), &analytical_solver);
}

TEST(Chain, WithoutASolverThatCanItIsUnsuitable) {
  const std::array oblique{make_plane(3, Vec3{0}, {1, 0, 0}), make_plane(3, Vec3{0}, {0.6, 0.8, 0})};
  Chain chain({.solvers = {&analytical_solver}});
  std::array<Vec3, 2> forces;
  EXPECT_EQ(chain.solve({400, {-mm, -2 * mm, 0}, Vec3{0}, oblique}, forces).outcome, Outcome::unsuitable);
}

/// Two points far away, at right angles. One pass misses what the second movement turns of the first one's pull: the
/// force s times (s / k) / distance, which is (s / k)^2 / distance of the proxy. Alone the analytical solver may be off
/// by a nanometer and not by more.
TEST(Chain, WhatTheAnalyticalSolverAnswersAloneIsOffByNoMoreThanANanometer) {
  constexpr double k = 400, s = 0.5, way = s / k;
  const auto solve = [](const SolverSet& solvers, double distance) {
    const std::array points{make_point(s, {distance, 0, 0}), make_point(s, {0, distance, 0})};
    Chain chain({.solvers = solvers});
    std::array<Vec3, 2> forces;
    return chain.solve({k, Vec3{0}, Vec3{0}, points}, forces);
  };
  for (const double distance : {2.0, 16.0, 128.0, 1024.0, 1500.0, 1600.0, 2048.0, 8192.0}) {  // m
    const double missed = way * way / distance;
    const Solution alone = solve({&analytical_solver}, distance);
    EXPECT_NEAR(alone.error_bound, missed, 0.01 * missed) << distance;
    EXPECT_EQ(alone.outcome, missed <= 1e-9 ? Outcome::capped : Outcome::unsuitable) << distance;
    const Solution both = solve({&analytical_solver, &exact_solver}, distance);
    EXPECT_EQ(both.outcome, Outcome::solved) << distance;
    EXPECT_EQ(both.solver, &exact_solver) << distance;
    EXPECT_LE(glm::distance(alone.proxy, both.proxy), alone.error_bound + both.error_bound) << distance;
  }
}

TEST(Chain, RefusesRubbishBeforeAnySolver) {
  const std::array primitives{make_plane(1, Vec3{0}, {0, 1, 0}), make_plane(-1, Vec3{0}, {0, 1, 0})};
  Chain chain;
  std::array<Vec3, 2> forces;
  const Solution solution = chain.solve({400, Vec3{0}, Vec3{0}, primitives}, forces);
  ASSERT_EQ(solution.outcome, Outcome::refused);
  EXPECT_EQ(solution.solver, nullptr);
  EXPECT_EQ(solution.rejection->primitive, 1U);
}

TEST(Chain, RestIsConstantToTheLastBit) {
  for (const Family family : {Family::allowed, Family::co_located, Family::spread}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Problem problem = make_problem(family, seed);
      std::vector<Vec3> forces(problem.primitives.size());
      Chain chain;
      Vec3 proxy{0};
      for (int tick = 0; tick < 50; ++tick) {
        const Solution solution = chain.solve(problem.balance(), forces);
        if (tick > 1) {
          ASSERT_EQ(solution.proxy, proxy) << name_of(family) << " " << seed << " tick " << tick;
        }
        proxy = solution.proxy;
      }
    }
  }
}

TEST(Chain, DoesNotAllocateWithinItsCapacity) {
  for (const Family family : all_families) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Problem problem = make_problem(family, seed);
      std::vector<Vec3> forces(problem.primitives.size());
      Chain chain({.solvers = SolverSet::usual().with(descent_solver), .capacity = 100});
      Chain descent({.solvers = {&descent_solver}, .max_iterations = 50, .capacity = 100});
      trap = true;
      for (int tick = 0; tick < 3; ++tick) {
        chain.solve(problem.balance(), forces);
      }
      descent.solve(problem.balance(), forces);
      trap = false;
      ASSERT_EQ(trapped, 0) << name_of(family) << " " << seed;
    }
  }
  trap = true;
  std::vector<int> counted(3);
  trap = false;
  EXPECT_EQ(trapped, 1) << "the trap itself";
}

}  // namespace
}  // namespace palpate::solver
