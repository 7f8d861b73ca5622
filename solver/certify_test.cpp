#include "solver/certify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "solver/analytical.h"
#include "solver/testing/problems.h"
#include "solver/testing/values.h"

namespace palpate::solver {
namespace {

TEST(Certify, IsTightForAFreeProxy) {
  const std::array primitives{make_directed_force(0.4, {1, 0, 0})};
  const std::array forces{Vec3{0.4, 0, 0}};
  const Balance balance{400, Vec3{0}, Vec3{0}, primitives};
  const Certificate off = certify(balance, {1.5 * mm, 0, 0}, forces);  // the proxy is 1 mm away from the probe
  EXPECT_GE(off.error_bound, 0.5 * mm * (1 - 1e-15));
  EXPECT_LE(off.error_bound, 0.5 * mm * (1 + 1e-12));
  EXPECT_NEAR(off.residual, 0.2, 1e-12);
}

TEST(Certify, APointThatHoldsIsExact) {
  const std::array primitives{make_point(1, Vec3{0})};
  const std::array forces{Vec3{-0.4, 0, 0}};
  const Certificate held = certify({400, {mm, 0, 0}, Vec3{0}, primitives}, Vec3{0}, forces);
  EXPECT_LE(held.error_bound, 1e-17);
}

TEST(Certify, ForcesOutsideTheirBodiesCountAsTheNearestInside) {
  // The plane can give 0.2 N; given 0.8 N it would seem to hold the proxy, which is 1.5 mm deeper.
  const std::array primitives{make_plane(0.2, Vec3{0}, {0, 1, 0})};
  const std::array forces{Vec3{0, 0.8, 0}};
  EXPECT_GE(certify({400, {0, -2 * mm, 0}, Vec3{0}, primitives}, Vec3{0}, forces).error_bound, 1.5 * mm);
}

TEST(Certify, HardConstraintsThatAreNotMet) {
  // One can be settled on, which costs the way there: the proxy is 1 mm away.
  const std::array plane{make_plane(infinity, Vec3{0}, {0, 1, 0})};
  const std::array forces{Vec3{0}, Vec3{0}};
  const Balance one{400, {0, -mm, 0}, Vec3{0}, plane};
  EXPECT_GE(certify(one, {0, -mm, 0}, std::span(forces).first(1)).error_bound, mm);
  // Two points cannot, and then there is no bound.
  const std::array points{make_point(infinity, Vec3{0}), make_point(infinity, {mm, 0, 0})};
  EXPECT_FALSE(std::isfinite(certify({400, Vec3{0}, Vec3{0}, points}, Vec3{0}, forces).error_bound));
}

// Whatever proxy and forces are given, the bound is not below the distance to the proxy solved.
TEST(Certify, IsNeverBelowTheErrorOfAnyGuess) {
  int checked = 0;
  for (const Family family : {Family::allowed, Family::oblique, Family::edge}) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const Problem problem = make_problem(family, seed);
      const Balance balance = problem.balance();
      std::vector<Vec3> forces(problem.primitives.size());
      const Solution solution = solve_analytical(balance, forces);
      if (solution.outcome != Outcome::solved || solution.error_bound > 1e-13) {
        continue;
      }
      Random random(seed);
      for (const double size : {1e-2, 1e-5, 1e-9}) {
        const Vec3 guess = solution.proxy + random.normal_vector(size);
        for (Vec3& force : forces) {
          force += random.normal_vector(size * balance.stiffness);
        }
        const double error = glm::length(guess - solution.proxy) - solution.error_bound;
        EXPECT_GE(certify(balance, guess, forces).error_bound, error) << name_of(family) << " " << seed;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 1000);
}

}  // namespace
}  // namespace palpate::solver
