/// Laws of the voxels' geometry on grids that combine all oddities: oblique, with rows and columns that are not quite
/// perpendicular, pixels that are not square, a tilted gantry and uneven slices.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <random>

#include "io/geometry.h"

namespace palpate::io {
namespace {

/// The definition in the class comment of Geometry, and nothing else.
Vec3 voxel_center(const Geometry& g, int i, int j, int k) {
  return g.slice_positions[static_cast<std::size_t>(k)] + (i * g.spacing_i) * g.direction_i +
         (j * g.spacing_j) * g.direction_j;
}

class OddGrid {
 public:
  explicit OddGrid(unsigned seed) : random_(seed) {
    Geometry& g = geometry;
    g.dimensions = {17, 13, 9};
    g.direction_i = unit();
    const Vec3 other = unit();
    g.direction_j = glm::normalize(other - g.direction_i * glm::dot(g.direction_i, other));
    // What rounding direction cosines does, and ten times more.
    const double skew = (seed % 2 == 0 ? 1 : -1) * between(0.002, 0.02);
    g.direction_j = glm::normalize(g.direction_j + skew * g.direction_i);
    g.spacing_i = between(0.3, 2);
    g.spacing_j = between(0.3, 2);
    const Vec3 normal = glm::normalize(glm::cross(g.direction_i, g.direction_j));
    Vec3 position = 200.0 * unit();
    for (int k = 0; k < g.dimensions.z; ++k) {
      g.slice_positions.push_back(position);
      position += between(0.4, 4) * normal + between(-1, 1) * g.direction_i + between(-1, 1) * g.direction_j;
    }
    g.step = (g.slice_positions.back() - g.slice_positions.front()) / (g.dimensions.z - 1.0);
    g.uniform = false;
  }

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 unit() {
    std::normal_distribution<double> normal;
    const double x = normal(random_), y = normal(random_), z = normal(random_);
    return glm::normalize(Vec3(x, y, z));
  }

  Geometry geometry;

 private:
  std::mt19937 random_;
};

constexpr unsigned grids = 200;

TEST(GeometryLaws, AVoxelsCenterComesBackAsItsIndex) {
  for (unsigned seed = 0; seed < grids; ++seed) {
    const Geometry g = OddGrid(seed).geometry;
    for (const glm::ivec3& at : {glm::ivec3(0), glm::ivec3(16, 0, 0), glm::ivec3(0, 12, 3), glm::ivec3(16, 12, 8),
                                 glm::ivec3(7, 5, 4), glm::ivec3(3, 11, 7)}) {
      const Vec3 center = voxel_center(g, at.x, at.y, at.z);
      EXPECT_EQ(g.to_index(center), Vec3(at)) << seed;
      EXPECT_LT(glm::length(g.to_patient(at) - center), 1e-11) << seed;
    }
  }
}

/// Between slices a position is the mean of the centers around it: linear along each axis.
TEST(GeometryLaws, BetweenCentersPositionsAreLinear) {
  for (unsigned seed = 0; seed < grids; ++seed) {
    OddGrid grid(seed);
    const Geometry& g = grid.geometry;
    for (int n = 0; n < 20; ++n) {
      const Vec3 index(grid.between(0, 16), grid.between(0, 12), grid.between(0, 8));
      const int k = std::min(static_cast<int>(index.z), 7);
      const double t = index.z - k;
      const Vec3 in_plane = (index.x * g.spacing_i) * g.direction_i + (index.y * g.spacing_j) * g.direction_j;
      const Vec3 expected = (1 - t) * voxel_center(g, 0, 0, k) + t * voxel_center(g, 0, 0, k + 1) + in_plane;
      EXPECT_LT(glm::length(g.to_patient(index) - expected), 1e-11) << seed;
      EXPECT_LT(glm::length(g.to_index(expected) - index), 1e-8) << seed;
      EXPECT_TRUE(g.contains(index));
    }
  }
}

/// Outside, the nearest step goes on, and the two directions still undo each other.
TEST(GeometryLaws, OutsideTheNearestStepGoesOn) {
  for (unsigned seed = 0; seed < grids; ++seed) {
    OddGrid grid(seed);
    const Geometry& g = grid.geometry;
    const Vec3 first = g.slice_positions[1] - g.slice_positions[0];
    const Vec3 last = g.slice_positions[8] - g.slice_positions[7];
    for (int n = 0; n < 10; ++n) {
      const double beyond = grid.between(0.1, 5);
      EXPECT_LT(glm::length(g.to_index(g.slice_positions[0] - beyond * first) - Vec3(0, 0, -beyond)), 1e-8) << seed;
      EXPECT_LT(glm::length(g.to_index(g.slice_positions[8] + beyond * last) - Vec3(0, 0, 8 + beyond)), 1e-8) << seed;
      EXPECT_LT(glm::length(g.to_patient({0, 0, -beyond}) - (g.slice_positions[0] - beyond * first)), 1e-11);
      EXPECT_LT(glm::length(g.to_patient({0, 0, 8 + beyond}) - (g.slice_positions[8] + beyond * last)), 1e-11);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 index(1, 1, 1);
        index[axis] = -beyond;
        EXPECT_FALSE(g.contains(index));
        index[axis] = g.dimensions[axis] - 1 + beyond;
        EXPECT_FALSE(g.contains(index));
        index[axis] = g.dimensions[axis] - 1;
        EXPECT_TRUE(g.contains(index));
        index[axis] = 0;
        EXPECT_TRUE(g.contains(index));
      }
    }
  }
}

/// f(p) = g . p is known everywhere, so its differences from voxel to voxel are, and they come back as g.
TEST(GeometryLaws, TheGradientOfALinearFieldComesBackInEveryInterval) {
  for (unsigned seed = 0; seed < grids; ++seed) {
    OddGrid grid(seed);
    const Geometry& g = grid.geometry;
    const Vec3 slope = 30.0 * grid.unit();
    const auto f = [&](int i, int j, int k) { return glm::dot(slope, voxel_center(g, i, j, k)); };
    for (int k = 0; k < 8; ++k) {
      const Vec3 differences(f(1, 0, k) - f(0, 0, k), f(0, 1, k) - f(0, 0, k), f(0, 0, k + 1) - f(0, 0, k));
      for (const double within : {0.0, 0.5, 0.999}) {
        EXPECT_LT(glm::length(g.index_gradient_to_patient(k + within) * differences - slope), 1e-8) << seed;
      }
    }
    const Vec3 differences(f(1, 0, 8) - f(0, 0, 8), f(0, 1, 8) - f(0, 0, 8), f(0, 0, 8) - f(0, 0, 7));
    EXPECT_LT(glm::length(g.index_gradient_to_patient(8) * differences - slope), 1e-8) << seed << ": the last slice";
  }
}

TEST(GeometryLaws, SliceSpacingIsTheMeanDistanceAlongTheNormal) {
  for (unsigned seed = 0; seed < grids; ++seed) {
    const Geometry g = OddGrid(seed).geometry;
    const Vec3 normal = glm::normalize(glm::cross(g.direction_i, g.direction_j));
    double sum = 0;
    for (std::size_t k = 0; k + 1 < 9; ++k) sum += glm::dot(g.slice_positions[k + 1] - g.slice_positions[k], normal);
    EXPECT_NEAR(g.slice_spacing(), sum / 8, 1e-11) << seed;
  }
}

}  // namespace
}  // namespace palpate::io
