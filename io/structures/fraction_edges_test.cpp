// The position of an edge within a voxel, from the fractions around it: against the formulas, on voxels that are not
// cubes.
#include "io/structures/fraction_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

namespace palpate::io {
namespace {

/// 3 x 3 x 3 voxels of 0.6 x 1.1 x 2.3 mm with any fractions that grow some way.
struct Neighborhood {
  const Vec3 size{0.6, 1.1, 2.3};
  Mask mask;

  Neighborhood(std::mt19937& random, Mask::Fractions fractions) {
    const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    mask.geometry.dimensions = mask.size = glm::ivec3(3);
    mask.geometry.spacing_i = size.x;
    mask.geometry.spacing_j = size.y;
    mask.geometry.step = {0, 0.4, size.z};
    mask.fractions = fractions;
    const Vec3 grows(any(-0.4, 0.4), any(-0.4, 0.4), any(-0.4, 0.4));
    const double middle = any(0, 1), noise = any(0, 0.3);
    for (int n = 0; n < 27; ++n) {
      const Vec3 at(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const double share = std::clamp(middle + glm::dot(grows, at) + any(-noise, noise), 0.0, 1.0);
      mask.occupancy.push_back(static_cast<std::uint8_t>(std::lround(share * Mask::full)));
    }
  }
  double share(int x, int y, int z) const {
    return static_cast<double>(mask.occupancy[mask.offset(x + 1, y + 1, z + 1)]) / Mask::full;
  }
};

// Youngs: where it rises is the mean of the differences across it, those nearer to the middle counting twice.
TEST(EdgeOfOccupancy, IsThePlaneThatLeavesAsMuchOfTheVoxel) {
  std::mt19937 random(3);
  int told = 0, untold = 0;
  for (int n = 0; n < 2000; ++n) {
    const Neighborhood around(random, Mask::Fractions::occupancy);
    Vec3 rise(0);  // from voxel to voxel
    for (int a = -1; a <= 1; ++a) {
      for (int b = -1; b <= 1; ++b) {
        const double weight = (a == 0 ? 2 : 1) * (b == 0 ? 2 : 1) / 32.0;
        rise += weight * Vec3(around.share(1, a, b) - around.share(-1, a, b),
                              around.share(a, 1, b) - around.share(a, -1, b),
                              around.share(a, b, 1) - around.share(a, b, -1));
      }
    }
    const double share = around.share(0, 0, 0);
    const float found = edge_distance({around.mask, nullptr}, 1, 1, 1);
    if (share < 0.08 || share > 0.92 || glm::length(rise) < 0.1) {
      EXPECT_TRUE(std::isnan(found)) << n;
      ++untold;
    } else {
      EXPECT_NEAR(static_cast<double>(found), plane_distance(around.size, rise / around.size, share), 1e-5) << n;
      ++told;
    }
  }
  EXPECT_GT(told, 500);
  EXPECT_GT(untold, 100);
}

// How far it is to where half is reached, as steep as it falls to a neighbor on the other side; along an axis that has
// none there, as steep as it is across the voxel.
TEST(EdgeOfProbability, IsWhereHalfIsReached) {
  std::mt19937 random(5);
  int told = 0, untold = 0;
  for (int n = 0; n < 2000; ++n) {
    const Neighborhood around(random, Mask::Fractions::probability);
    const double here = around.share(0, 0, 0);
    double steep = 0;
    bool beside = false;
    for (int axis = 0; axis < 3; ++axis) {
      std::array<double, 2> there{};
      for (std::size_t side = 0; side < 2; ++side) {
        glm::ivec3 to(0);
        to[axis] = side == 0 ? -1 : 1;
        there[side] = around.share(to.x, to.y, to.z);
      }
      double most = 0;
      for (const double one : there) {
        if ((one >= 0.5) != (here >= 0.5)) most = std::max(most, std::abs(one - here));
      }
      beside = beside || most > 0;
      const double slope = (most > 0 ? most : 0.5 * (there[1] - there[0])) / around.size[axis];
      steep += slope * slope;
    }
    const float found = edge_distance({around.mask, nullptr}, 1, 1, 1);
    if (here < 0.08 || here > 0.92 || !beside) {
      EXPECT_TRUE(std::isnan(found)) << n;
      ++untold;
    } else {
      EXPECT_NEAR(static_cast<double>(found), (here - 0.5) / std::sqrt(steep), 1e-5) << n;
      ++told;
    }
  }
  EXPECT_GT(told, 500);
  EXPECT_GT(untold, 100);
}

/// With one more voxel on each side, like the one beside it.
Mask continued(const Mask& mask) {
  Mask larger = mask;
  larger.geometry.dimensions += 2;
  larger.size = larger.geometry.dimensions;
  larger.occupancy.clear();
  for (int k = -1; k <= mask.size.z; ++k) {
    for (int j = -1; j <= mask.size.y; ++j) {
      for (int i = -1; i <= mask.size.x; ++i) {
        const glm::ivec3 in = glm::clamp(glm::ivec3(i, j, k), glm::ivec3(0), mask.size - 1);
        larger.occupancy.push_back(mask.occupancy[mask.offset(in.x, in.y, in.z)]);
      }
    }
  }
  return larger;
}

// A structure that runs out of the scan goes on as it ends: the scan's end does not tilt its edge.
TEST(EdgeOfFractions, IsTheSameAtTheEndOfTheScanAsIfItWentOn) {
  std::mt19937 random(7);
  int told = 0;
  for (int n = 0; n < 200; ++n) {
    for (const Mask::Fractions fractions : {Mask::Fractions::occupancy, Mask::Fractions::probability}) {
      const Mask mask = Neighborhood(random, fractions).mask;
      const Mask larger = continued(mask);
      for (int at = 0; at < 27; ++at) {
        const int i = at % 3, j = at / 3 % 3, k = at / 9;
        const float found = edge_distance({mask, nullptr}, i, j, k),
                    wanted = edge_distance({larger, nullptr}, i + 1, j + 1, k + 1);
        ASSERT_EQ(std::isnan(found), std::isnan(wanted)) << n << ' ' << at;
        if (std::isnan(found)) continue;
        ASSERT_FLOAT_EQ(found, wanted) << n << ' ' << at;
        ++told;
      }
    }
  }
  EXPECT_GT(told, 2000);
}

}  // namespace
}  // namespace palpate::io
