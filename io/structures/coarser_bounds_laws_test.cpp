// Transfer to the lattice of every second node and back, with missing bricks, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <random>
#include <vector>

#include "io/structures/coarser_bounds.h"

namespace palpate::io {
namespace {

/// A number that belongs to a node, and to no other.
float number_at(const glm::ivec3& node) {
  return static_cast<float>(node.x + 64 * node.y + 4096 * node.z);
}

glm::ivec3 node_in(const glm::ivec3& brick, int n) {
  return 8 * brick + glm::ivec3(n % 8, n / 8 % 8, n / 64);
}

/// `missing`: of a hundred.
DistanceBounds some_bricks(std::mt19937& random, const glm::ivec3& count, unsigned missing) {
  DistanceBounds made;
  made.bricks.lattice.bricks = count;
  made.bricks.lattice.origin = {3, -7, 11};
  made.bricks.lattice.spacing = {0.5, 0.75, 1.25};
  for (int n = 0; n < count.x * count.y * count.z; ++n) {
    if (random() % 100 < missing) {
      made.bricks.slot.push_back(random() % 2 == 0 ? NodeBricks::inside : NodeBricks::outside);
      continue;
    }
    made.bricks.slot.push_back(static_cast<std::int32_t>(made.bricks.count()));
    made.bricks.place.emplace_back(n % count.x, n / count.x % count.y, n / (count.x * count.y));
    for (int in = 0; in < 512; ++in) {
      const float number = number_at(node_in(made.bricks.place.back(), in));
      made.lower.push_back(-number - 1);
      made.upper.push_back(number + 2);
    }
  }
  return made;
}

std::vector<float> numbers_of(const NodeBricks& bricks) {
  std::vector<float> f;
  for (const glm::ivec3& place : bricks.place) {
    for (int in = 0; in < 512; ++in) f.push_back(number_at(node_in(place, in)));
  }
  return f;
}

TEST(CoarserBounds, AreThoseOfEverySecondNode) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    const glm::ivec3 count(2 + seed % 4, 2 + seed / 2 % 3, 1 + seed % 5);
    const DistanceBounds fine = some_bricks(random, count, 0);
    const Coarser made = coarser(fine, numbers_of(fine.bricks), 99);
    const NodeBricks& bricks = made.bounds.bricks;
    EXPECT_EQ(bricks.lattice.origin, fine.bricks.lattice.origin);
    EXPECT_EQ(bricks.lattice.spacing, 2.0 * fine.bricks.lattice.spacing);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(bricks.lattice.bricks[axis], (count[axis] + 1) / 2);
    ASSERT_EQ(made.f.size(), bricks.count() * 512);
    for (std::size_t slot = 0; slot < bricks.count(); ++slot) {
      for (int n = 0; n < 512; ++n) {
        const glm::ivec3 node = 2 * node_in(bricks.place[slot], n);
        const std::size_t at = slot * 512 + static_cast<std::size_t>(n);
        if (glm::all(glm::lessThan(node, 8 * count))) {
          ASSERT_EQ(made.f[at], number_at(node)) << seed;
          ASSERT_EQ(made.bounds.lower[at], -number_at(node) - 1);
          ASSERT_EQ(made.bounds.upper[at], number_at(node) + 2);
        } else {
          ASSERT_EQ(made.bounds.lower[at], -99) << "beyond the lattice";
          ASSERT_EQ(made.bounds.upper[at], 99);
        }
      }
    }
  }
}

/// The nearest node, brick by brick: of the eight that a coarser one is made of, the one with the fewest steps aside.
TEST(CoarserBounds, TakeTheNearestNodeWhereABrickIsMissing) {
  int stood_in = 0, left_out = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed + 50);
    const glm::ivec3 count(4, 4, 4);
    const DistanceBounds fine = some_bricks(random, count, 75);
    const Coarser made = coarser(fine, numbers_of(fine.bricks), 5);
    const NodeBricks& bricks = made.bounds.bricks;
    for (int brick = 0; brick < 8; ++brick) {
      const glm::ivec3 place(brick % 2, brick / 2 % 2, brick / 4);
      const std::int32_t slot = bricks.slot_at(place.x, place.y, place.z);
      bool any = false;
      for (int part = 0; part < 8; ++part) {
        any =
            any || fine.bricks.slot_at(2 * place.x + part % 2, 2 * place.y + part / 2 % 2, 2 * place.z + part / 4) >= 0;
      }
      ASSERT_EQ(slot >= 0, any);
      if (!any) {
        ++left_out;
        EXPECT_EQ(slot, fine.bricks.slot_at(2 * place.x, 2 * place.y, 2 * place.z)) << "all on one side";
        continue;
      }
      ASSERT_EQ(bricks.place[static_cast<std::size_t>(slot)], place);
      for (int n = 0; n < 512; ++n) {
        const glm::ivec3 node = 2 * node_in(place, n), own = node / 8;
        const std::size_t at = static_cast<std::size_t>(slot) * 512 + static_cast<std::size_t>(n);
        if (fine.bricks.slot_at(own.x, own.y, own.z) >= 0) {
          ASSERT_EQ(made.f[at], number_at(node));
          continue;
        }
        ++stood_in;
        ASSERT_EQ(made.bounds.lower[at], -5);
        ASSERT_EQ(made.bounds.upper[at], 5);
        // A number of one of the bricks that are as few steps aside as any.
        int fewest = 4;
        std::vector<float> allowed;
        for (int part = 0; part < 8; ++part) {
          const glm::ivec3 other = 2 * place + glm::ivec3(part % 2, part / 2 % 2, part / 4);
          if (fine.bricks.slot_at(other.x, other.y, other.z) < 0) continue;
          const glm::ivec3 apart = glm::abs(other - own);
          const int steps = apart.x + apart.y + apart.z;
          if (steps < fewest) allowed.clear();
          fewest = std::min(fewest, steps);
          if (steps == fewest) allowed.push_back(number_at(glm::clamp(node, 8 * other, 8 * other + 7)));
        }
        ASSERT_TRUE(std::ranges::find(allowed, made.f[at]) != allowed.end()) << seed;
      }
    }
  }
  EXPECT_GT(stood_in, 1000);
  EXPECT_GT(left_out, 0);
}

// Keys: the interpolation is exact for polynomials of second degree, whatever the bricks; beyond the coarser lattice
// the numbers stay as they were.
TEST(CoarserBounds, GoBackByInterpolation) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed + 200);
    const glm::ivec3 count(5, 3, 4);
    const DistanceBounds fine = some_bricks(random, count, seed % 2 == 0 ? 0 : 15);
    const NodeBricks coarse = coarser(fine, numbers_of(fine.bricks), 1).bounds.bricks;
    const auto value = [](const glm::dvec3& fine_node) {
      const glm::dvec3 at = fine_node / 16.0;
      return 3 + at.x * (1 - 0.5 * at.x) - 2 * at.y * (0.3 + at.y) + at.z * (2 + 0.25 * at.z) + at.x * at.y -
             0.5 * at.y * at.z;
    };
    std::vector<float> numbers;
    for (const glm::ivec3& place : coarse.place) {
      for (int n = 0; n < 512; ++n) numbers.push_back(static_cast<float>(value(2.0 * glm::dvec3(node_in(place, n)))));
    }
    constexpr float before = 1e6F;
    std::vector<float> back(fine.bricks.count() * 512, before);
    refine(coarse, numbers, fine.bricks, back);
    const auto held = [&](const glm::ivec3& node) {
      const glm::ivec3 brick = glm::ivec3(glm::floor(glm::dvec3(node) / 8.0));
      return coarse.slot_at(brick.x, brick.y, brick.z) >= 0;
    };
    int inner = 0, kept = 0;
    for (std::size_t slot = 0; slot < fine.bricks.count(); ++slot) {
      for (int n = 0; n < 512; ++n) {
        const glm::ivec3 node = node_in(fine.bricks.place[slot], n), cell = node / 2;
        bool all = true;
        for (int k = -1; k <= 2; ++k) {
          for (int j = -1; j <= 2; ++j) {
            for (int i = -1; i <= 2; ++i) all = all && held(cell + glm::ivec3(i, j, k));
          }
        }
        const float found = back[slot * 512 + static_cast<std::size_t>(n)];
        if (all) {
          ++inner;
          ASSERT_NEAR(static_cast<double>(found), value(glm::dvec3(node)), 1e-4) << seed;
        } else {
          ++kept;
          ASSERT_EQ(found, before) << seed;
        }
      }
    }
    EXPECT_GT(inner, 1000);
    EXPECT_GT(kept, 100);
  }
}

}  // namespace
}  // namespace palpate::io
