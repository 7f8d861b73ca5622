// Closest points on analytic surfaces, on lattices with a different spacing along each axis.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <random>
#include <vector>

#include "io/structures/closest_points.h"

namespace palpate::io {
namespace {

struct OddBricks {
  std::mt19937 random;
  NodeBricks bricks;

  /// `missing`: of so many bricks one is not there.
  OddBricks(unsigned seed, const glm::ivec3& count, unsigned missing = 0) : random(seed) {
    bricks.lattice.bricks = count;
    bricks.lattice.spacing = {between(0.5, 1.5), between(0.5, 1.5), between(0.5, 1.5)};
    for (int n = 0; n < count.x * count.y * count.z; ++n) {
      if (missing > 0 && random() % missing == 0) {
        bricks.slot.push_back(NodeBricks::outside);
        continue;
      }
      bricks.slot.push_back(static_cast<std::int32_t>(bricks.count()));
      bricks.place.emplace_back(n % count.x, n / count.x % count.y, n / (count.x * count.y));
    }
  }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec3 unit() {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(Vec3(x, y, z));
  }
  Vec3 middle() const { return 0.5 * Vec3(bricks.lattice.bricks * brick_edge - 1) * bricks.lattice.spacing; }
  double coarsest() const {
    const Vec3& h = bricks.lattice.spacing;
    return std::max({h.x, h.y, h.z});
  }
  double finest() const {
    const Vec3& h = bricks.lattice.spacing;
    return std::min({h.x, h.y, h.z});
  }
  /// mm along the lattice's axes from its origin.
  Vec3 place_of(std::size_t slot, int n) const {
    const glm::ivec3 in(n % brick_edge, n / brick_edge % brick_edge, n / (brick_edge * brick_edge));
    return Vec3(bricks.place[slot] * brick_edge + in) * bricks.lattice.spacing;
  }
  /// Whether a point lies within the bricks, so many nodes from their ends.
  bool holds(const Vec3& mm, double nodes) const {
    const Vec3 node = mm / bricks.lattice.spacing, last(bricks.lattice.bricks * brick_edge - 1);
    return glm::all(glm::greaterThan(node, Vec3(nodes))) && glm::all(glm::lessThan(node, last - nodes));
  }
  std::vector<float> values(const std::function<double(const Vec3&)>& f) const {
    std::vector<float> all;
    for (std::size_t slot = 0; slot < bricks.count(); ++slot) {
      for (int n = 0; n < 512; ++n) all.push_back(static_cast<float>(f(place_of(slot, n))));
    }
    return all;
  }
  void for_nodes(const std::vector<Vec3f>& closest,
                 const std::function<void(const Vec3& node, const Vec3f& closest)>& look) const {
    ASSERT_EQ(closest.size(), bricks.count() * 512);
    for (std::size_t slot = 0; slot < bricks.count(); ++slot) {
      for (int n = 0; n < 512; ++n) look(place_of(slot, n), closest[slot * 512 + static_cast<std::size_t>(n)]);
    }
  }
};

// A plane's are the feet, whatever the field's slope; farther away those of neighbors, two steps beside the own at
// most.
TEST(ClosestPoints, OfAPlaneAreTheFeet) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    OddBricks odd(seed, {3, 2, 3});
    const Vec3 normal = odd.unit();
    const double offset = glm::dot(normal, odd.middle()) + odd.between(-2, 2),
                 slope = seed % 3 == 0 ? 1 : odd.between(0.4, 2.5);
    const std::vector<float> f = odd.values([&](const Vec3& at) { return slope * (glm::dot(normal, at) - offset); });
    const double side = glm::length(odd.bricks.lattice.spacing);
    int near = 0, far = 0;
    odd.for_nodes(closest_points(odd.bricks, f, 12, 1), [&](const Vec3& node, const Vec3f& closest) {
      const double away = glm::dot(normal, node) - offset;
      const Vec3 foot = node - away * normal;
      if (std::abs(away) > 12 || !odd.holds(foot, 3)) return;
      ASSERT_NE(closest.x, nowhere) << seed;
      EXPECT_LT(std::abs(glm::dot(normal, Vec3(closest)) - offset), 1e-3) << "on the plane, " << seed;
      const Vec3 steps = glm::abs(foot - node) / odd.bricks.lattice.spacing;
      const bool in_reach = std::max({steps.x, steps.y, steps.z}) < 3 && odd.holds(node, 2);
      if (in_reach && std::abs(slope * away) < 2.1 * odd.coarsest()) {
        EXPECT_LT(glm::distance(Vec3(closest), foot), 2e-3) << seed;
        ++near;
      } else {
        EXPECT_LT(glm::distance(Vec3(closest), foot), 2 * side) << seed;
        ++far;
      }
    });
    EXPECT_GT(near, 300) << seed;
    EXPECT_GT(far, 300) << seed;
  }
}

// On a curved surface: at the closest point the way to the node stands upright on it. A polynomial of second degree is
// interpolated without an error.
TEST(ClosestPoints, OfACurvedSurfaceStandUprightOnIt) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    OddBricks odd(seed + 100, {2, 3, 3});
    const Vec3 normal = odd.unit(), one = odd.unit(), other = odd.unit(), middle = odd.middle();
    const glm::dmat3 bend = odd.between(-0.06, 0.06) * glm::outerProduct(one, one) +
                            odd.between(-0.06, 0.06) * glm::outerProduct(other, other);
    const double slope = odd.between(0.5, 2), offset = odd.between(-1, 1);
    const auto value = [&](const Vec3& at) {
      const Vec3 away = at - middle;
      return slope * (glm::dot(normal, away) + offset + 0.5 * glm::dot(away, bend * away));
    };
    const auto gradient = [&](const Vec3& at) { return slope * (normal + bend * (at - middle)); };
    int seen = 0;
    odd.for_nodes(closest_points(odd.bricks, odd.values(value), 6, 1), [&](const Vec3& node, const Vec3f& found) {
      const Vec3 steep = gradient(node), closest(found);
      const double away = std::abs(value(node)) / glm::length(steep);
      if (glm::length(steep) < 0.5 * slope || std::abs(value(node)) > 2.1 * odd.coarsest()) return;
      if (away > 2 * odd.finest() || !odd.holds(node, 4.5)) return;
      ASSERT_NE(found.x, nowhere) << seed;
      const Vec3 upright = glm::normalize(gradient(closest));
      EXPECT_LT(std::abs(value(closest)) / glm::length(gradient(closest)), 3e-3) << "on the surface, " << seed;
      const Vec3 way = node - closest;
      EXPECT_LT(glm::length(way - glm::dot(way, upright) * upright), 0.02) << seed;
      ++seen;
    });
    EXPECT_GT(seen, 100) << seed;
  }
}

// Between a node and one on the other side where the field has no slope that leads to the surface: one of each sign.
TEST(ClosestPoints, OfAFieldOfSignsAloneLieBetweenTheNodes) {
  OddBricks odd(7, {2, 2, 2});
  const Vec3 h = odd.bricks.lattice.spacing;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double share : {0.25, 0.5, 0.9}) {
      // Inside is one layer of nodes: nothing leads on from one side to the other, and the nearer one counts.
      const std::vector<float> f = odd.values([&](const Vec3& at) {
        return std::lround(at[axis] / h[axis]) == 6 ? share * h[axis] : -(1 - share) * h[axis];
      });
      odd.for_nodes(closest_points(odd.bricks, f, 5, 1), [&](const Vec3& node, const Vec3f& closest) {
        const double steps = node[axis] / h[axis] - 6;
        if (std::abs(steps) > 1.5) return;
        ASSERT_NE(closest.x, nowhere);
        const double apart = std::abs(static_cast<double>(closest[axis]) - node[axis]);
        EXPECT_LE(apart, 1.001 * h[axis]) << axis << ' ' << share;
        for (int aside = 1; aside < 3; ++aside) {
          EXPECT_NEAR(static_cast<double>(closest[(axis + aside) % 3]), node[(axis + aside) % 3], 1e-3);
        }
      });
    }
  }
}

// As far as the band, through every brick in between; and nothing is said where there is no surface.
TEST(ClosestPoints, AreHandedOnAsFarAsTheBand) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool back : {false, true}) {
      glm::ivec3 count(1);
      count[axis] = 6;
      OddBricks odd(static_cast<unsigned>(axis), count);
      const double h = odd.bricks.lattice.spacing[axis], end = 47 * h;
      const auto away = [&](const Vec3& at) { return back ? end - at[axis] - 2.3 * h : at[axis] - 2.3 * h; };
      const double band = 40 * h;
      odd.for_nodes(closest_points(odd.bricks, odd.values(away), band, 1), [&](const Vec3& node, const Vec3f& closest) {
        if (std::abs(away(node)) > band) return;
        ASSERT_NE(closest.x, nowhere) << axis;
        EXPECT_NEAR(glm::distance(Vec3(closest), node), std::abs(away(node)), 0.02 * h) << axis;
      });
    }
  }
  OddBricks odd(3, {2, 2, 2});
  odd.for_nodes(closest_points(odd.bricks, odd.values([](const Vec3&) { return 1; }), 5, 1),
                [](const Vec3&, const Vec3f& closest) { EXPECT_EQ(closest.x, nowhere); });
}

// Where bricks are missing none is worse than the best that its neighbors know; every one lies on the surface.
TEST(ClosestPoints, NeedNotAllBricks) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    OddBricks odd(seed + 300, {4, 3, 3}, 4);
    const Vec3 normal = odd.unit();
    const double offset = glm::dot(normal, odd.middle());
    const auto away = [&](const Vec3& at) { return glm::dot(normal, at) - offset; };
    const std::vector<Vec3f> closest = closest_points(odd.bricks, odd.values(away), 8, 1);
    EXPECT_EQ(closest, closest_points(odd.bricks, odd.values(away), 8, 3)) << "on any number of threads";
    int known = 0;
    odd.for_nodes(closest, [&](const Vec3& node, const Vec3f& found) {
      if (found.x == nowhere) return;
      ++known;
      EXPECT_LT(std::abs(away(Vec3(found))), 1e-3) << seed;
      EXPECT_GE(glm::distance(node, Vec3(found)), std::abs(away(node)) - 1e-3) << seed;
    });
    EXPECT_GT(known, 1000) << seed;
  }
}

}  // namespace
}  // namespace palpate::io
