#include "solver/descent.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "solver/testing/problems.h"
#include "solver/testing/values.h"

namespace palpate::solver {
namespace {

TEST(Descent, StepsAreOfTheLengthGiven) {  // equation (22)
  const Balance balance{400, {10 * mm, 0, 0}, Vec3{0}, {}};
  DescentOptions options;
  options.max_iterations = 3;
  const Solution solution = solve_descent(balance, options, {});
  EXPECT_EQ(solution.outcome, Outcome::capped);
  EXPECT_EQ(solution.iterations, 3);
  EXPECT_NEAR(solution.proxy.x, 3 * mm, 1e-17);
}

TEST(Descent, StepShrinksWhereTheResidualTurns) {  // equation (23)
  // From 0 towards 1.5 mm: 1 mm, 2 mm (turned: the next step is 0.7 mm), 1.3 mm (turned again: 0.49 mm), 1.79 mm.
  const Balance balance{400, {1.5 * mm, 0, 0}, Vec3{0}, {}};
  DescentOptions options;
  options.max_iterations = 4;
  EXPECT_NEAR(solve_descent(balance, options, {}).proxy.x, 1.79 * mm, 1e-17);
}

TEST(Descent, EndsAtItsCapWhereTheStepDoesNotShrink) {
  const Balance balance{400, {1.5 * mm, 0, 0}, Vec3{0}, {}};
  const Solution solution = solve_descent(balance, {.reduction = 1}, {});
  EXPECT_EQ(solution.outcome, Outcome::capped);
  EXPECT_EQ(solution.iterations, 10000);
}

/// As one of a chain's solvers it keeps to the cap of the run, which is less than its own.
TEST(Descent, KeepsToTheCapOfTheRun) {
  int capped = 0;
  for (const Family family : all_families) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Problem problem = make_problem(family, seed);
      std::vector<Vec3> forces(problem.primitives.size());
      for (const int cap : {1, 2, 7, 40}) {
        const Solution solution = descent_solver.solve(problem.balance(), forces, nullptr, {.max_iterations = cap});
        EXPECT_LE(solution.iterations, cap) << name_of(family) << " " << seed;
        if (solution.outcome != Outcome::capped) continue;
        ++capped;
        EXPECT_EQ(solution.iterations, cap) << name_of(family) << " " << seed;
      }
    }
  }
  EXPECT_GT(capped, 400);
  // Without a cap it has its own.
  const Balance balance{400, {1.5 * mm, 0, 0}, o, {}};
  EXPECT_EQ(descent_solver.solve(balance, {}, nullptr, {}).iterations, solve_descent(balance, {}, {}).iterations);
}

TEST(Descent, EndsWhereTheStepIsBelowTheSmallest) {
  const std::array primitives{make_directed_force(0.4, {0, 1, 0})};
  const Balance balance{400, {1.5 * mm, 0, 0}, Vec3{0}, primitives};
  std::array<Vec3, 1> forces;
  const Solution fine = solve_descent(balance, {}, forces);
  EXPECT_EQ(fine.outcome, Outcome::solved);
  EXPECT_LE(glm::length(fine.proxy - Vec3{1.5 * mm, mm, 0}), fine.error_bound);
  EXPECT_EQ(forces[0], (Vec3{0, 0.4, 0}));
  DescentOptions coarse;
  coarse.smallest_step = 1e-6;
  EXPECT_LT(solve_descent(balance, coarse, forces).iterations, fine.iterations);
}

TEST(Descent, StartsAtThePreviousProxy) {
  const Balance balance{400, Vec3{0}, {0, 0, 5 * mm}, {}};
  DescentOptions options;
  options.max_iterations = 1;
  EXPECT_NEAR(solve_descent(balance, options, {}).proxy.z, 4 * mm, 1e-17);
}

TEST(Descent, BoundIsTrueOfAProxyHeldByAPlane) {
  const std::array primitives{make_plane(1, Vec3{0}, {0, 1, 0})};
  const Balance balance{400, {0.5 * mm, -2 * mm, 0}, {0, 0.1 * mm, 0.3 * mm}, primitives};
  std::array<Vec3, 1> forces;
  const Solution solution = solve_descent(balance, {}, forces);
  const double error = glm::length(solution.proxy - Vec3{0.5 * mm, 0, 0});
  EXPECT_GE(solution.error_bound, error);
}

TEST(Descent, HardConstraintsAreNotItsBusiness) {
  const std::array primitives{make_plane(infinity, Vec3{0}, {0, 1, 0})};
  std::array<Vec3, 1> forces;
  EXPECT_EQ(solve_descent({400, Vec3{0}, Vec3{0}, primitives}, {}, forces).outcome, Outcome::unsuitable);
}

}  // namespace
}  // namespace palpate::solver
