// Bounds of the distance at every node, against the definition: the nearest node of any plane that is known to be
// inside or outside, found by exhaustive search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

#include "io/structures/distance_bounds.h"

namespace palpate::io {
namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

/// Planes at uneven heights, each with a few blots of nodes inside.
struct Blots {
  std::mt19937 random;
  OutlinePlanes planes;
  std::vector<std::vector<char>> inside;  // by plane, row by row
  std::vector<std::vector<float>> known;

  Blots(unsigned seed, bool has_known) : random(seed) {
    planes.lattice.bricks = {2, 3, static_cast<int>(3 + seed % 4)};
    planes.lattice.spacing = {any(0.5, 1.2), any(0.5, 1.2), any(0.5, 1.2)};
    planes.play_mm = any(1, 2);
    planes.band_mm = any(2.5, 5);
    const glm::ivec3 size = planes.lattice.bricks * NodeBricks::edge;
    for (int z = static_cast<int>(random() % 3); z < size.z; z += 1 + static_cast<int>(random() % 3)) {
      planes.node.push_back(z);
      std::vector<char> nodes(static_cast<std::size_t>(size.x * size.y), 0);
      const double x = any(0, 16), y = any(0, 24), radius = any(0, 6);
      for (int n = 0; n < size.x * size.y; ++n) {
        nodes[static_cast<std::size_t>(n)] = std::hypot(n % size.x - x, n / size.x - y) < radius ? 1 : 0;
      }
      inside.push_back(nodes);
      known.emplace_back();
      for (int n = 0; has_known && n < size.x * size.y; ++n) {
        known.back().push_back(random() % 4 == 0 ? static_cast<float>(any(-0.6, 0.6))
                                                 : std::numeric_limits<float>::quiet_NaN());
      }
    }
    planes.compute = [this](std::size_t plane, PlaneDistances& distances) { compute(plane, distances); };
  }
  double any(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

  /// mm^2 within a plane, by looking at all of its nodes.
  double squared(std::size_t plane, const glm::ivec2& from, bool wanted) const {
    const glm::ivec3 size = planes.lattice.bricks * NodeBricks::edge;
    double least = unreached;
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        if ((inside[plane][static_cast<std::size_t>(j * size.x + i)] != 0) != wanted) continue;
        const double x = (i - from.x) * planes.lattice.spacing.x, y = (j - from.y) * planes.lattice.spacing.y;
        least = std::min(least, x * x + y * y);
      }
    }
    return least;
  }
  void compute(std::size_t plane, PlaneDistances& distances) const {
    const glm::ivec3 size = planes.lattice.bricks * NodeBricks::edge;
    const auto to_float = [](double mm) { return mm == unreached ? PlaneDistances::far : static_cast<float>(mm); };
    for (int n = 0; n < size.x * size.y; ++n) {
      const glm::ivec2 node(n % size.x, n / size.x);
      distances.to_inside.push_back(to_float(squared(plane, node, true)));
      distances.to_outside.push_back(to_float(squared(plane, node, false)));
    }
    distances.known = known[plane];
  }
};

struct Expected {
  double in = unreached, out = unreached;  // mm, no farther than the band
  double lower = 0, upper = 0;
  bool near = false;
};

/// By the comment of DistanceBounds, from the distances of all planes.
Expected bounds_at(const Blots& blots, const std::vector<PlaneDistances>& all, const glm::ivec3& node) {
  const OutlinePlanes& planes = blots.planes;
  const auto at = static_cast<std::size_t>(node.y * planes.lattice.bricks.x * NodeBricks::edge + node.x);
  Expected result;
  double known = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t n = 0; n < planes.node.size(); ++n) {
    const double up = (planes.node[n] - node.z) * planes.lattice.spacing.z;
    result.in = std::min(result.in, std::sqrt(static_cast<double>(all[n].to_inside[at]) + up * up));
    result.out = std::min(result.out, std::sqrt(static_cast<double>(all[n].to_outside[at]) + up * up));
    if (planes.node[n] == node.z && !all[n].known.empty()) known = static_cast<double>(all[n].known[at]);
  }
  result.near = std::max(result.in, result.out) < planes.band_mm;
  const double in = std::min(result.in, planes.band_mm), out = std::min(result.out, planes.band_mm);
  const double play = planes.play_mm, off = 0.01 * play;
  const Vec3& h = planes.lattice.spacing;
  const double least = 0.01 * std::min({h.x, h.y, h.z});
  // No farther than the nearest that is known on the other side; and no nearer than that, less the play.
  result.lower = out > play && in <= play ? std::max(-in, out - play) : -in;
  result.upper = in > play && out <= play ? std::min(out, play - in) : out;
  if (!std::isnan(known)) {
    result.lower = std::max(result.lower, known - off);
    result.upper = std::min(result.upper, known + off);
  }
  if (in == 0) result.lower = std::max(result.lower, least);
  if (out == 0) result.upper = std::min(result.upper, -least);
  if (result.lower > result.upper) std::swap(result.lower, result.upper);
  return result;
}

TEST(DistanceBoundsLaws, AreTheNearestOnEitherSideLessThePlay) {
  int bricks = 0, all_outside = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Blots blots(seed, seed % 2 == 1);
    std::vector<PlaneDistances> all(blots.planes.node.size());
    for (std::size_t n = 0; n < all.size(); ++n) blots.compute(n, all[n]);
    const DistanceBounds bounds = bounds_of(blots.planes, 1);
    const glm::ivec3 count = blots.planes.lattice.bricks;
    EXPECT_EQ(bounds.bricks.lattice.spacing, blots.planes.lattice.spacing);
    ASSERT_EQ(bounds.bricks.slot.size(), static_cast<std::size_t>(count.x * count.y * count.z));
    ASSERT_EQ(bounds.lower.size(), bounds.bricks.count() * NodeBricks::nodes);
    ASSERT_EQ(bounds.upper.size(), bounds.lower.size());
    for (int brick = 0; brick < count.x * count.y * count.z; ++brick) {
      const glm::ivec3 place(brick % count.x, brick / count.x % count.y, brick / (count.x * count.y));
      const std::int32_t slot = bounds.bricks.slot_at(place.x, place.y, place.z);
      if (slot >= 0) {
        ASSERT_EQ(bounds.bricks.place[static_cast<std::size_t>(slot)], place);
      }
      bool near = false;
      double in = unreached, out = unreached;
      for (int n = 0; n < 512; ++n) {
        const Expected expected = bounds_at(blots, all, 8 * place + glm::ivec3(n % 8, n / 8 % 8, n / 64));
        near = near || expected.near;
        in = std::min(in, expected.in);
        out = std::min(out, expected.out);
        if (slot < 0) continue;
        const std::size_t at = static_cast<std::size_t>(slot) * 512 + static_cast<std::size_t>(n);
        ASSERT_NEAR(static_cast<double>(bounds.lower[at]), expected.lower, 1e-5) << seed << ' ' << n;
        ASSERT_NEAR(static_cast<double>(bounds.upper[at]), expected.upper, 1e-5) << seed << ' ' << n;
      }
      ASSERT_EQ(slot >= 0, near) << seed;
      if (!near) {
        EXPECT_EQ(slot, in < out ? NodeBricks::inside : NodeBricks::outside);
      }
      bricks += near ? 1 : 0;
      all_outside += slot == NodeBricks::outside ? 1 : 0;
    }
    const DistanceBounds again = bounds_of(blots.planes, 3);
    EXPECT_EQ(again.lower, bounds.lower) << "on any number of threads";
    EXPECT_EQ(again.upper, bounds.upper);
    EXPECT_EQ(again.bricks.slot, bounds.bricks.slot);
  }
  EXPECT_GT(bricks, 20);
  EXPECT_GT(all_outside, 2);
}

// A body that fills all of a brick and more: that brick lies inside.
TEST(DistanceBoundsLaws, ABrickFarWithinIsInside) {
  OutlinePlanes planes;
  planes.lattice.bricks = {5, 5, 5};
  planes.band_mm = 3;
  planes.play_mm = 1.5;
  for (int z = 0; z < 40; ++z) planes.node.push_back(z);
  // A cube of nodes 4 to 35, in a plane: the distance to its nearest edge.
  planes.compute = [](std::size_t plane, PlaneDistances& distances) {
    const bool has = plane >= 4 && plane <= 35;
    for (int n = 0; n < 1600; ++n) {
      const int i = n % 40, j = n / 40;
      const double x = std::max({0, 4 - i, i - 35}), y = std::max({0, 4 - j, j - 35});
      const int within = std::min({i - 3, 36 - i, j - 3, 36 - j});
      distances.to_inside.push_back(has ? static_cast<float>(x * x + y * y) : PlaneDistances::far);
      distances.to_outside.push_back(has && within > 0 ? static_cast<float>(within * within) : 0);
    }
  };
  const DistanceBounds bounds = bounds_of(planes, 2);
  for (int brick = 0; brick < 125; ++brick) {
    const glm::ivec3 place(brick % 5, brick / 5 % 5, brick / 25);
    const bool within = std::min({place.x, place.y, place.z}) > 0 && std::max({place.x, place.y, place.z}) < 4;
    const std::int32_t slot = bounds.bricks.slot_at(place.x, place.y, place.z);
    EXPECT_EQ(slot == NodeBricks::inside, within) << brick;
    EXPECT_EQ(slot >= 0, !within) << brick;
  }
}

}  // namespace
}  // namespace palpate::io
