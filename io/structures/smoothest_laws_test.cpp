// The smoothest surface within bounds: it keeps them, and is a plane or a ball if these fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "io/structures/smoothest.h"

namespace palpate::io {
namespace {

/// Bounds of a body whose distance is known, each node's as loose as labels make them, on a lattice that is not cubic.
struct LooseBounds {
  std::mt19937 random;
  DistanceBounds bounds;

  LooseBounds(unsigned seed, const glm::ivec3& count, const std::function<double(const Vec3&)>& distance,
              const Vec3& spacing, double band)
      : random(seed) {
    NodeBricks& bricks = bounds.bricks;
    bricks.lattice.bricks = count;
    bricks.lattice.spacing = spacing;
    for (int n = 0; n < count.x * count.y * count.z; ++n) {
      const glm::ivec3 place(n % count.x, n / count.x % count.y, n / (count.x * count.y));
      std::vector<double> all;
      for (int in = 0; in < 512; ++in) all.push_back(distance(node(place, in)));
      if (std::ranges::none_of(all, [&](double mm) { return std::abs(mm) < band; })) {
        bricks.slot.push_back(all[0] > 0 ? NodeBricks::inside : NodeBricks::outside);
        continue;
      }
      bricks.slot.push_back(static_cast<std::int32_t>(bricks.count()));
      bricks.place.push_back(place);
      // A node is at most as far from the surface as from one of the other side: up to a voxel's diagonal farther.
      const double play = glm::length(spacing);
      for (const double mm : all) {
        const double loose = std::uniform_real_distribution<double>(0.2, 1)(random) * play;
        bounds.lower.push_back(static_cast<float>(mm > 0 ? std::max(0.01, mm - loose) : mm - loose));
        bounds.upper.push_back(static_cast<float>(mm > 0 ? mm + loose : std::min(-0.01, mm + loose)));
      }
    }
  }
  Vec3 node(const glm::ivec3& place, int in) const {
    return Vec3(8 * place + glm::ivec3(in % 8, in / 8 % 8, in / 64)) * bounds.bricks.lattice.spacing;
  }
  /// Of each node of a brick: its place and its number.
  void for_each(const std::vector<float>& f, const std::function<void(const Vec3&, std::size_t, double)>& look) const {
    ASSERT_EQ(f.size(), bounds.lower.size());
    for (std::size_t n = 0; n < f.size(); ++n) {
      look(node(bounds.bricks.place[n / 512], static_cast<int>(n % 512)), n, static_cast<double>(f[n]));
    }
  }
};

/// Sum of the squares of what bends the numbers along an axis, over nodes of a kind.
double roughness(const LooseBounds& loose, const std::vector<float>& f,
                 const std::function<bool(const Vec3&)>& counts) {
  double sum = 0;
  loose.for_each(f, [&](const Vec3& at, std::size_t n, double here) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{8}, std::size_t{64}}) {
      const std::size_t within = n % 512 / step % 8;
      if (within == 0 || within == 7 || !counts(at)) continue;
      const double bend = static_cast<double>(f[n - step]) + static_cast<double>(f[n + step]) - 2 * here;
      sum += bend * bend;
    }
  });
  return sum;
}

TEST(SmoothestLaws, StayOnTheirSideAndWithinTheirBounds) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Vec3 normal = glm::normalize(Vec3(0.4, -0.7 + 0.4 * seed, 0.6));
    const Vec3 spacing(0.9, 1.2, 1.0 + 0.3 * seed);
    const auto distance = [&](const Vec3& at) { return glm::dot(normal, at - Vec3(11, 12, 13)); };
    const LooseBounds loose(seed, {3, 3, 3}, distance, spacing, 6);
    const std::vector<float> f = smoothest(loose.bounds, {.coarser = static_cast<int>(seed % 2)});
    loose.for_each(f, [&](const Vec3& at, std::size_t n, double found) {
      if (loose.bounds.lower[n] > 0) {
        ASSERT_GT(found, 0) << "on its own side";
      } else if (loose.bounds.upper[n] < 0) {
        ASSERT_LT(found, 0) << "on its own side";
      }
      const Vec3 inner = glm::abs(at / spacing - 11.5);
      if (std::abs(distance(at)) > 2 || std::max({inner.x, inner.y, inner.z}) > 8) return;
      ASSERT_GE(f[n], loose.bounds.lower[n]);
      ASSERT_LE(f[n], loose.bounds.upper[n]);
    });
    SmoothestOptions more{.coarser = static_cast<int>(seed % 2)};
    more.threads = 3;
    EXPECT_EQ(smoothest(loose.bounds, more), f);
  }
}

// What lies within loose bounds of a plane is the plane, near enough: away from the lattice's ends, where a node lacks
// neighbors and stays as it was.
TEST(SmoothestLaws, AreFlatWhereAPlaneFits) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Vec3 spacing = seed % 2 == 0 ? Vec3(1, 1, 1) : Vec3(0.8, 1.1, 1.3);
    const Vec3 middle = 16.0 * spacing, normal = glm::normalize(Vec3(0.3 + 0.2 * seed, -0.5, 0.7));
    const auto distance = [&](const Vec3& at) { return glm::dot(normal, at - middle); };
    const LooseBounds loose(seed + 10, {4, 4, 4}, distance, spacing, 7);
    std::vector<float> first;
    for (std::size_t n = 0; n < loose.bounds.lower.size(); ++n) {
      first.push_back(0.5F * (loose.bounds.lower[n] + loose.bounds.upper[n]));
    }
    const std::vector<float> f = smoothest(loose.bounds);
    const auto counts = [&](const Vec3& at) {
      return std::abs(distance(at)) < 1.5 && glm::length(at / spacing - 16.0) < 9;
    };
    double squares = 0, count = 0;
    loose.for_each(f, [&](const Vec3& at, std::size_t, double found) {
      if (!counts(at)) return;
      ASSERT_NEAR(found, distance(at), 0.35) << seed;
      squares += (found - distance(at)) * (found - distance(at));
      count += 1;
    });
    EXPECT_GT(count, 300);
    EXPECT_LT(std::sqrt(squares / count), 0.1) << seed;
    EXPECT_LT(roughness(loose, f, counts), 0.03 * roughness(loose, first, counts)) << seed;
  }
}

TEST(SmoothestLaws, AreRoundWhereABallFits) {
  for (const bool coarse_first : {false, true}) {
    const Vec3 spacing(1, 0.9, 1.1), center = 16.2 * spacing;
    const double radius = 9;
    const auto distance = [&](const Vec3& at) { return radius - glm::distance(at, center); };
    const LooseBounds loose(5, {4, 4, 4}, distance, spacing, 7);
    const std::vector<float> f = smoothest(loose.bounds, {.coarser = coarse_first ? 1 : 0});
    double squares = 0, count = 0;
    loose.for_each(f, [&](const Vec3& at, std::size_t, double found) {
      if (std::abs(distance(at)) > 1.5) return;
      ASSERT_NEAR(found, distance(at), 0.4);
      squares += (found - distance(at)) * (found - distance(at));
      count += 1;
    });
    EXPECT_GT(count, 1000);
    EXPECT_LT(std::sqrt(squares / count), 0.12);
  }
}

// Half-way between two sides the distance has a kink, which is no roughness: the sides stay where they are.
TEST(SmoothestLaws, LeaveBothSidesOfAPlateWhereTheyAre) {
  for (const double half : {1.4, 2.1, 3.2}) {
    const Vec3 spacing(1, 0.9, 1.1), middle = 16.2 * spacing, normal = glm::normalize(Vec3(0.2, 0.5, 0.9));
    const auto distance = [&](const Vec3& at) { return half - std::abs(glm::dot(normal, at - middle)); };
    const LooseBounds loose(8, {4, 4, 4}, distance, spacing, 7);
    const std::vector<float> f = smoothest(loose.bounds);
    double squares = 0, count = 0;
    loose.for_each(f, [&](const Vec3& at, std::size_t, double found) {
      if (std::abs(distance(at)) > 1 || glm::length(at / spacing - 16.2) > 9) return;
      squares += (found - distance(at)) * (found - distance(at));
      count += 1;
    });
    EXPECT_GT(count, 300);
    EXPECT_LT(std::sqrt(squares / count), 0.2) << half;
  }
}

}  // namespace
}  // namespace palpate::io
