/// Hard constraints whose common point is known, given by positions far from it: they miss each other by the rounding
/// of these alone. More of them than a point needs are ill-conditioned: the search may end at its cap, but not in a
/// refusal.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "solver/certify.h"
#include "solver/exact.h"
#include "solver/testing/problems.h"

namespace palpate::solver {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A plane, line or point through `common`, given by a position on it that is up to `reach` from there.
Primitive through(Random& random, const Vec3& common, double reach) {
  const Vec3 direction = random.unit_vector();
  const Vec3 across = glm::normalize(glm::cross(direction, random.unit_vector()));
  switch (random.below(5)) {
    case 0:
      return make_point(infinity, common);
    case 1:
      return make_line(infinity, common + reach * direction, direction);
    default:
      return make_plane(infinity, common + reach * across, direction);
  }
}

double distance_of(const Primitive& primitive, const Vec3& proxy) {
  const Vec3 to = proxy - primitive.position;
  switch (primitive.type) {
    case PrimitiveType::plane:
      return std::max(0.0, -glm::dot(primitive.direction, to));
    case PrimitiveType::line:
      return glm::length(to - glm::dot(primitive.direction, to) * primitive.direction);
    default:
      return glm::length(to);
  }
}

TEST(HardConstraints, ThatMeetButForTheRoundingOfTheirPositionsAreNeverIncompatible) {
  int unknown = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    const Vec3 common = random.normal_vector(random.log_uniform(1e-6, 1));
    Problem problem;
    problem.probe = problem.previous_proxy = common + random.normal_vector(1e-3);
    double largest = 0;  // m: from the probe
    for (std::size_t n = 2 + random.below(5); n > 0; --n) {
      problem.primitives.push_back(through(random, common, random.log_uniform(1e-6, 10)));
      largest = std::max(largest, glm::distance(problem.primitives.back().position, problem.probe));
    }
    if (random.below(2) == 0) problem.primitives.push_back(make_directed_force(0.3, random.unit_vector()));
    if (random.below(2) == 0) problem.primitives.push_back(make_point(0.5, common + random.normal_vector(1e-3)));
    const auto answer = [&] {
      std::vector<Vec3> forces(problem.primitives.size());
      ExactScratch scratch;
      return solve_exact(problem.balance(), forces, scratch);
    };
    const Solution one = answer();
    ASSERT_NE(one.outcome, Outcome::refused) << seed << ": " << describe(*one.rejection);
    for (const Primitive& primitive : problem.primitives) {
      if (!std::isinf(primitive.strength)) continue;
      ASSERT_LE(distance_of(primitive, one.proxy), 2 * hard_tolerance * largest) << seed;
    }
    // Whichever of them stands first.
    std::ranges::reverse(problem.primitives);
    const Solution other = answer();
    ASSERT_NE(other.outcome, Outcome::refused) << seed;
    const double rounding = 16 * std::numeric_limits<double>::epsilon() * largest;
    ASSERT_LE(glm::distance(other.proxy, one.proxy), one.error_bound + other.error_bound + rounding) << seed;
    unknown += one.error_bound > 0.01 ? 1 : 0;
  }
  // What stands for infinity is raised where it is too small, and forces of that size round: of all answers the best is
  // kept, not the last (62 balances).
  EXPECT_LT(unknown, 30);
}

/// Of hard constraints without a common point the one that is named is the farthest from the proxy, with its distance,
/// wherever it stands among the others.
TEST(HardConstraints, ThatCannotBeMetAreNamedByTheFarthest) {
  int not_last = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const Vec3 middle = random.normal_vector(0.05);
    Problem problem;
    problem.probe = problem.previous_proxy = middle + random.normal_vector(1e-3);
    // Two points alone have none; the others stand anywhere near.
    for (int n = 0; n < 2; ++n) {
      problem.primitives.push_back(make_point(infinity, middle + random.normal_vector(1e-3)));
    }
    for (std::size_t n = 1 + random.below(3); n > 0; --n) {
      problem.primitives.push_back(through(random, middle + random.normal_vector(1e-3), 1e-3));
      problem.primitives.push_back(make_point(0.5, middle + random.normal_vector(1e-3)));
    }
    for (const bool backwards : {false, true}) {
      if (backwards) std::ranges::reverse(problem.primitives);
      std::vector<Vec3> forces(problem.primitives.size());
      ExactScratch scratch;
      const Solution solution = solve_exact(problem.balance(), forces, scratch);
      ASSERT_EQ(solution.outcome, Outcome::refused) << seed;
      double farthest = 0, last = 0;  // m: of those that are not met
      for (const Primitive& primitive : problem.primitives) {
        if (!std::isinf(primitive.strength)) continue;
        const double distance = distance_of(primitive, solution.proxy);
        farthest = std::max(farthest, distance);
        if (distance > 1e-6) last = distance;
      }
      not_last += last < 0.99 * farthest ? 1 : 0;
      const Rejection& rejection = *solution.rejection;
      ASSERT_LT(rejection.primitive, problem.primitives.size()) << seed;
      const Primitive& named = problem.primitives[rejection.primitive];
      EXPECT_EQ(rejection.flaw, Flaw::incompatible) << seed;
      EXPECT_TRUE(std::isinf(named.strength)) << seed;
      EXPECT_NEAR(distance_of(named, solution.proxy), farthest, 1e-12) << seed;
      EXPECT_NEAR(rejection.value, farthest, 1e-12) << seed;
    }
  }
  EXPECT_GT(not_last, 10) << "else this test shows nothing";
}

}  // namespace
}  // namespace palpate::solver
