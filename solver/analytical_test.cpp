#include "solver/analytical.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "solver/testing/problems.h"
#include "solver/testing/values.h"

namespace palpate::solver {
namespace {

constexpr double k = 400;  // N/m

struct Answer {
  Solution solution;
  std::vector<Vec3> forces;
};

Answer solve(const std::vector<Primitive>& primitives, const Vec3& probe) {
  Answer answer;
  answer.forces.resize(primitives.size());
  answer.solution = solve_analytical({k, probe, o, primitives}, answer.forces);
  return answer;
}

// Solved, with the proxy derived by hand, inside its own bound of 1e-14 m, and with forces that balance.
void expect_proxy(const std::vector<Primitive>& primitives, const Vec3& probe, const Vec3& proxy) {
  const Answer answer = solve(primitives, probe);
  ASSERT_EQ(answer.solution.outcome, Outcome::solved);
  EXPECT_EQ(answer.solution.solver, &analytical_solver);
  EXPECT_LE(glm::length(answer.solution.proxy - proxy), 2e-18 + 4e-16 * glm::length(proxy));
  EXPECT_LE(answer.solution.error_bound, 1e-14);
  Vec3 sum{0};
  for (const Vec3& force : answer.forces) {
    sum += force;
  }
  EXPECT_LE(glm::length(sum - (answer.solution.proxy - probe) * k), 1e-13);
}

TEST(Analytical, NothingLeavesTheProxyAtTheProbe) {
  expect_proxy({}, {mm, -mm, 2 * mm}, {mm, -mm, 2 * mm});
}

TEST(Analytical, ForceMovesByStrengthOverStiffness) {  // equation (12)
  expect_proxy({make_directed_force(0.8, y), make_directed_force(0.4, x)}, {mm, 0, 0}, {2 * mm, 2 * mm, 0});
}

TEST(Analytical, PlaneHoldsOrGivesWay) {  // equation (13)
  expect_proxy({make_plane(1, o, y)}, {mm, -2 * mm, 0}, {mm, 0, 0});
  expect_proxy({make_plane(0.4, o, y)}, {mm, -2 * mm, 0}, {mm, -mm, 0});
  expect_proxy({make_plane(1, o, y)}, {mm, 2 * mm, 0}, {mm, 2 * mm, 0});
}

TEST(Analytical, LineHoldsOrGivesWay) {  // equations (14) and (15)
  expect_proxy({make_line(3, o, z)}, {3 * mm, 4 * mm, 7 * mm}, {0, 0, 7 * mm});
  expect_proxy({make_line(1, o, z)}, {3 * mm, 4 * mm, 7 * mm}, {1.5 * mm, 2 * mm, 7 * mm});
}

TEST(Analytical, PointHoldsOrGivesWay) {  // equation (16)
  expect_proxy({make_point(3, o)}, {0, 3 * mm, 4 * mm}, o);
  expect_proxy({make_point(1, o)}, {0, 3 * mm, 4 * mm}, {0, 1.5 * mm, 2 * mm});
}

TEST(Analytical, OrthogonalPlanes) {
  const std::vector planes{make_plane(1, o, x), make_plane(0.4, o, y), make_plane(9, o, z)};
  expect_proxy(planes, {-mm, -2 * mm, -3 * mm}, {0, -mm, 0});
  expect_proxy(planes, {mm, -2 * mm, -3 * mm}, {mm, -mm, 0});
}

TEST(Analytical, OpposedPlanesAreNeverBothActive) {
  const std::vector planes{make_plane(0.4, o, y), make_plane(0.8, o, -y)};
  expect_proxy(planes, {0, -2 * mm, 0}, {0, -mm, 0});
  expect_proxy(planes, {0, 3 * mm, 0}, {0, mm, 0});
}

TEST(Analytical, CodirectionalPlanesAddTheirStrengths) {
  const std::vector planes{make_plane(0.4, o, y), make_plane(0, o, y), make_plane(0.8, o, y)};
  expect_proxy(planes, {0, -5 * mm, 0}, {0, -2 * mm, 0});
  const Answer held = solve(planes, {0, -1.5 * mm, 0});  // 0.6 N, shared one to two
  ASSERT_EQ(held.solution.outcome, Outcome::solved);
  EXPECT_NEAR(held.forces[0].y, 0.2, 1e-15);
  EXPECT_EQ(held.forces[1], o);
  EXPECT_NEAR(held.forces[2].y, 0.4, 1e-15);
}

TEST(Analytical, TellsHowOftenItMovedTheProxy) {  // once for what was merged, not at all for forces
  EXPECT_EQ(solve({make_directed_force(1, x)}, o).solution.iterations, 0);
  EXPECT_EQ(solve({make_plane(1, o, x), make_plane(2, o, x)}, o).solution.iterations, 1);
  EXPECT_EQ(solve({make_plane(1, o, x), make_directed_force(1, z), make_plane(1, o, y)}, o).solution.iterations, 2);
  EXPECT_EQ(solve({make_plane(1, o, x), make_plane(1, o, y), make_plane(1, o, z)}, o).solution.iterations, 3);
}

// What rounding may have set apart counts as one, what is further apart does not.
TEST(Analytical, MergesWhatOnlyRoundingSetsApart) {
  const auto movements = [](double apart, double turned) {
    const Vec3 at{10 * mm, 20 * mm, 5 * mm};
    std::vector<int> counts;
    for (const auto& [a, b] : {std::pair{make_plane(1, at, x), make_plane(1, at + apart * x, x + turned * y)},
                               std::pair{make_line(1, at, z), make_line(1, at + apart * x, z + turned * y)},
                               std::pair{make_point(1, at), make_point(1, at + apart * x + turned * y)}}) {
      counts.push_back(solve({a, b}, o).solution.iterations);
    }
    return counts;
  };
  EXPECT_EQ(movements(0, 0), (std::vector{1, 1, 1}));
  EXPECT_EQ(movements(1e-17, 0), (std::vector{1, 1, 1}));
  EXPECT_EQ(movements(1e-16, 0), (std::vector{2, 2, 2}));
  EXPECT_EQ(movements(0, 4e-16), (std::vector{1, 1, 2}));
  EXPECT_EQ(movements(0, 2e-15), (std::vector{2, 2, 2}));
}

TEST(Analytical, ParallelLinesAddTheirStrengths) {
  const std::vector lines{make_line(0.4, o, z), make_line(0.4, {0, 0, 5}, -z)};
  expect_proxy(lines, {4 * mm, 0, mm}, {2 * mm, 0, mm});
  const Answer held = solve(lines, {mm, 0, 0});
  EXPECT_NEAR(held.forces[0].x, -0.2, 1e-15);
  EXPECT_NEAR(held.forces[1].x, -0.2, 1e-15);
}

TEST(Analytical, PointsAddTheirStrengths) {
  expect_proxy({make_point(0.4, o), make_point(0.8, o)}, {0, 0, 5 * mm}, {0, 0, 2 * mm});
}

TEST(Analytical, HardMembersShareAMergedForceAlone) {
  const Answer held = solve({make_plane(5, o, y), make_plane(infinity, o, y), make_plane(infinity, o, y)}, {0, -mm, 0});
  ASSERT_EQ(held.solution.outcome, Outcome::solved);
  EXPECT_EQ(held.forces[0], o);
  EXPECT_NEAR(held.forces[1].y, 0.2, 1e-15);
  EXPECT_NEAR(held.forces[2].y, 0.2, 1e-15);
}

TEST(Analytical, LineAlongTheNormalOfAPlane) {
  const std::vector both{make_plane(0.4, o, z), make_line(0.8, o, z)};
  expect_proxy(both, {5 * mm, 0, -3 * mm}, {3 * mm, 0, -2 * mm});
}

TEST(Analytical, LineInAPlane) {
  expect_proxy({make_plane(1, o, z), make_line(0.8, o, x)}, {mm, 5 * mm, -2 * mm}, {mm, 3 * mm, 0});
}

TEST(Analytical, PlaneThenPoint) {
  expect_proxy({make_plane(2, o, z), make_point(0.8, o)}, {3 * mm, 4 * mm, -mm}, {1.8 * mm, 2.4 * mm, 0});
}

TEST(Analytical, LineThenPoint) {
  expect_proxy({make_line(4, o, z), make_point(0.8, o)}, {3 * mm, 0, 5 * mm}, {0, 0, 3 * mm});
}

TEST(Analytical, ForceAlongALine) {
  expect_proxy({make_directed_force(0.4, z), make_line(2, o, z)}, {mm, 0, 0}, {0, 0, mm});
}

TEST(Analytical, OrderDoesNotMatter) {
  const std::vector forwards{make_point(0.2, o), make_plane(1, o, z), make_line(0.8, o, x),
                             make_directed_force(0.1, y)};
  const std::vector backwards(forwards.rbegin(), forwards.rend());
  const Vec3 probe{mm, 5 * mm, -2 * mm};
  const Answer a = solve(forwards, probe);
  const Answer b = solve(backwards, probe);
  ASSERT_EQ(a.solution.outcome, Outcome::solved);
  EXPECT_EQ(a.solution.proxy, b.solution.proxy);
  for (std::size_t i = 0; i < forwards.size(); ++i) {
    EXPECT_EQ(a.forces[i], b.forces[forwards.size() - 1 - i]);
  }
}

TEST(Analytical, RefusesWhatOnePassGetsWrong) {
  const Vec3 oblique = glm::normalize(Vec3{1, 1, 1});
  const Vec3 probe{-mm, -2 * mm, -3 * mm};
  const std::vector<std::vector<Primitive>> unsuitable{
      {make_directed_force(0.5, x), make_line(3, o, z), make_plane(3, o, oblique)},
      {make_plane(3, o, x), make_plane(3, o, oblique)},
      {make_plane(3, o, x), make_plane(3, o, glm::normalize(Vec3{1, 1e-6, 0}))},
      {make_line(1, o, x), make_line(0.3, o, y)},
      {make_point(0.5, {mm, 0, 0}), make_point(0.5, {0, mm, 0})},
      {make_plane(3, o, z), make_point(0.8, {0, mm, -2 * mm})},
  };
  for (const auto& primitives : unsuitable) {
    EXPECT_EQ(solve(primitives, probe).solution.outcome, Outcome::unsuitable) << primitives.size();
  }
}

TEST(Analytical, APlaneSwitchedOnByALaterMoveIsNoticed) {
  // At its turn the second plane is idle: the probe is before it. The first one's move takes the proxy behind it.
  const Vec3 slanted = glm::normalize(Vec3{-1, 0.2, 0});
  const std::vector planes{make_plane(1, {0.1 * mm, 0, 0}, slanted), make_plane(2, o, x)};
  EXPECT_EQ(solve(planes, {-mm, -mm, 0}).solution.outcome, Outcome::unsuitable);
}

TEST(Analytical, MergesThousands) {
  const std::vector planes(10000, make_plane(1e-4, o, y));
  const Answer answer = solve(planes, {0, -4 * mm, 0});
  ASSERT_EQ(answer.solution.outcome, Outcome::solved);
  EXPECT_NEAR(answer.solution.proxy.y, -1.5 * mm, 1e-14);
}

TEST(Analytical, SolvesWhereFrictionIsAboutToSlip) {
  // The pose where a stylus rests: the pull along the plane is the point's strength to the last bits.
  const Vec3 at{0.0056593669516060239, 0.0013211055795581451, -0.00081163062015960773};
  const std::vector rest{make_plane(1, at, {0.11200159154212248, 0.54581415208091721, 0.83038699103503599}),
                         make_point(0.1, at)};
  const Answer answer = solve(rest, {0.00564, 0, -0.00282});
  EXPECT_EQ(answer.solution.outcome, Outcome::solved);
  EXPECT_LT(answer.solution.error_bound, 1e-14);
}

TEST(Analytical, SolvesEveryTickOfAStylusThatComesToRestOnFriction) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    const Vec3 probe = 5 * mm * random.normal_vector(1);
    Vec3 at = probe + 3 * mm * random.normal_vector(1);
    // The surface curves away beneath a proxy that creeps: its normal turns with the place.
    const Vec3 center = probe + 30 * mm * random.unit_vector();
    const double friction = random.uniform(0.02, 0.3);
    for (int tick = 0; tick < 200; ++tick) {
      const Vec3 normal = glm::normalize(at - center);
      const std::array rest{make_plane(2, at, normal), make_point(friction, at)};
      std::array<Vec3, 2> forces{};
      const Solution solution = solve_analytical({k, probe, at, rest}, forces);
      ASSERT_EQ(solution.outcome, Outcome::solved) << "seed " << seed << ", tick " << tick;
      at = solution.proxy;
    }
  }
}

}  // namespace
}  // namespace palpate::solver
