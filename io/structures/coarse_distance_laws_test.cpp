// Distances far from a surface, on their coarse lattice, against bodies with a known distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <vector>

#include "io/structures/coarse_distance.h"

namespace palpate::io {
namespace {

// 4 mm apart, or as far as makes 400 000 nodes of the box; and a cubic interpolation has all its nodes anywhere in it.
TEST(CoarseLattice, HoldsItsBoxAndNotTooManyNodes) {
  std::mt19937 random(2);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int trial = 0; trial < 200; ++trial) {
    const double x = any(-500, 500), y = any(-500, 500), z = any(-500, 500);
    const Vec3 low(x, y, z);
    const double wide = any(0, 900), tall = any(0, 900), deep = any(0, 900);
    const Vec3 high = low + Vec3(wide, tall, deep);
    const CoarseLattice lattice = coarse_lattice(low, high);
    const double volume = std::max(wide, 1.0) * std::max(tall, 1.0) * std::max(deep, 1.0);
    EXPECT_NEAR(lattice.spacing, std::max(4.0, std::cbrt(volume / 4e5)), 1e-9);
    const Vec3 last = lattice.origin + lattice.spacing * Vec3(lattice.size - 1);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(lattice.origin[axis] + lattice.spacing, low[axis]) << "a node before the box";
      EXPECT_GE(last[axis] - lattice.spacing, high[axis]) << "and one behind it";
      EXPECT_LE(lattice.origin[axis] + 2 * lattice.spacing, low[axis] + lattice.spacing) << "and no more";
      EXPECT_LE(last[axis], high[axis] + 2.5 * lattice.spacing);
    }
    EXPECT_EQ(lattice.count(), static_cast<std::size_t>(lattice.size.x) * static_cast<std::size_t>(lattice.size.y) *
                                   static_cast<std::size_t>(lattice.size.z));
  }
}

/// A ball in bricks on an oblique lattice that is not cubic: with its true closest points, in some bricks alone.
struct BallInBricks {
  NodeBricks bricks;
  std::vector<float> f;
  std::vector<Vec3f> closest;
  Vec3 center{0};
  double radius = 0;

  explicit BallInBricks(unsigned seed) {
    std::mt19937 random(seed);
    const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    NodeLattice& lattice = bricks.lattice;
    lattice.bricks = {5, 6, 4};
    lattice.spacing = {any(0.8, 1.4), any(0.8, 1.4), any(0.8, 1.4)};
    const double x = any(-1, 1), y = any(-1, 1), z = any(0.2, 1);
    lattice.axes = glm::dmat3(glm::rotate(glm::dmat4(1), any(0, 3), glm::normalize(Vec3(x, y, z))));
    lattice.origin = {any(-80, 80), any(-80, 80), any(-80, 80)};
    center = lattice.position(0.5 * Vec3(lattice.bricks * NodeBricks::edge));
    radius = 11;
    for (int n = 0; n < 5 * 6 * 4; ++n) {
      const glm::ivec3 place(n % 5, n / 5 % 6, n / 30);
      double least = 1e9, most = -1e9;
      std::vector<float> values;
      std::vector<Vec3f> points;
      for (int in = 0; in < 512; ++in) {
        const Vec3 at = lattice.position(Vec3(place * NodeBricks::edge + glm::ivec3(in % 8, in / 8 % 8, in / 64)));
        const double depth = radius - glm::distance(at, center);
        least = std::min(least, depth);
        most = std::max(most, depth);
        values.push_back(static_cast<float>(depth));
        const Vec3 on_surface = center + radius * glm::normalize(at - center);
        points.emplace_back(glm::transpose(lattice.axes) * (on_surface - lattice.origin));
      }
      if (least > 1 || most < -1) {
        bricks.slot.push_back(least > 1 ? NodeBricks::inside : NodeBricks::outside);
        continue;
      }
      bricks.slot.push_back(static_cast<std::int32_t>(bricks.count()));
      bricks.place.push_back(place);
      f.insert(f.end(), values.begin(), values.end());
      closest.insert(closest.end(), points.begin(), points.end());
    }
  }
};

TEST(CoarseDistance, IsThatOfABallEverywhere) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const BallInBricks ball(seed);
    CoarseLattice coarse = coarse_lattice(ball.center - Vec3(60, 45, 52), ball.center + Vec3(50, 66, 58));
    coarse.spacing = 3.7;  // not of the bricks' nodes
    const std::vector<float> mm = coarse_distances(coarse, ball.bricks, ball.f, ball.closest);
    ASSERT_EQ(mm.size(), coarse.count());
    int inside = 0;
    for (std::size_t n = 0; n < mm.size(); ++n) {
      const auto at = static_cast<int>(n);
      const Vec3 node(at % coarse.size.x, at / coarse.size.x % coarse.size.y, at / (coarse.size.x * coarse.size.y));
      const double depth = ball.radius - glm::distance(coarse.origin + coarse.spacing * node, ball.center);
      const double found = static_cast<double>(mm[n]);
      // Points of the surface, so never less than the distance; and of one some 4 mm beside the closest.
      ASSERT_GE(std::abs(found), std::abs(depth) - 1e-3) << seed;
      const double aside = 4 * std::sqrt(1 + std::abs(depth) / ball.radius);
      ASSERT_LE(std::abs(found), std::hypot(depth, aside) + 0.03 * std::abs(depth)) << seed << ' ' << depth;
      if (std::abs(depth) > 1) {  // a node's side is that of the nearest node of a brick
        ASSERT_EQ(found > 0, depth > 0) << seed << ' ' << depth;
      }
      inside += depth > 1 ? 1 : 0;
    }
    EXPECT_GT(inside, 50) << seed;
  }
}

}  // namespace
}  // namespace palpate::io
