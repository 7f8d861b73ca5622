// Central differences, against fields whose derivative is known at every voxel.
#include "io/fields/gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <memory>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "testdata/scan.h"

namespace palpate::io {
namespace {

using testdata::Grid;

std::shared_ptr<const Volume> scan_for_differences(const testdata::Phantom& phantom, const Grid& grid,
                                                   const testdata::Acquisition& acquisition = {}) {
  return std::make_shared<const Volume>(testdata::scan(phantom, testdata::make_geometry(grid), acquisition));
}

TEST(CentralDifferences, AreHalfTheDifferenceOfTheNeighbors) {
  Grid grid;
  grid.size = {9, 8, 7};
  grid.spacing = {0.5, 0.7, 2};
  const auto volume = scan_for_differences(testdata::make_sphere(2), grid, {.noise = 300});
  const auto gradients = GradientKernel(volume, GradientKernel::CentralDifferences{}).whole();
  const auto v = [&](int i, int j, int k) { return volume->value_at(i, j, k); };
  for (int k = 1; k < 6; ++k) {
    for (int j = 1; j < 7; ++j) {
      for (int i = 1; i < 8; ++i) {
        const Vec3 expected((v(i + 1, j, k) - v(i - 1, j, k)) / 1.0, (v(i, j + 1, k) - v(i, j - 1, k)) / 1.4,
                            (v(i, j, k + 1) - v(i, j, k - 1)) / 4.0);
        ASSERT_LT(glm::length(Vec3(gradients[volume->offset(i, j, k)]) - expected), 1e-3);
      }
    }
  }
}

/// Stored numbers of any type, a sixth of them padding, some of it in stretches.
template <typename Stored>
Volume with_padding(unsigned seed) {
  Grid grid;
  grid.size = {75, 9, 6};
  grid.spacing = {0.5, 0.7, 2};
  Volume volume;
  volume.geometry = testdata::make_geometry(grid);
  std::mt19937 random(seed);
  std::vector<Stored> voxels(75 * 9 * 6);
  bool is_padding = false;
  for (Stored& voxel : voxels) {
    if (random() % 6 == 0) is_padding = random() % 6 == 0;
    voxel = static_cast<Stored>(is_padding ? 0 : 1 + random() % 3000);
    if (std::is_floating_point_v<Stored> && is_padding && random() % 2 == 0) {
      voxel = std::numeric_limits<Stored>::quiet_NaN();
    }
  }
  volume.voxels = std::move(voxels);
  volume.padding = {-1, 0};
  volume.slope = 0.5;
  return volume;
}

/// Along each axis the difference of those neighbors that there are, the voxel itself in the place of one that is none.
TEST(CentralDifferences, ArePlainDifferencesOfWhatThereIsBesidePadding) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const auto volume = std::make_shared<const Volume>(seed % 3 == 0   ? with_padding<std::int16_t>(seed)
                                                       : seed % 3 == 1 ? with_padding<std::uint16_t>(seed)
                                                                       : with_padding<float>(seed));
    const auto gradients = GradientKernel(volume, GradientKernel::CentralDifferences{}).whole();
    const glm::ivec3 size = volume->geometry.dimensions;
    const Vec3 spacing(0.5, 0.7, 2);
    const auto counts = [&](const glm::ivec3& at) {
      return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, size)) &&
             !volume->is_padding(at.x, at.y, at.z) && std::isfinite(volume->value_at(at.x, at.y, at.z));
    };
    int beside = 0;
    for (int n = 0; n < size.x * size.y * size.z; ++n) {
      const glm::ivec3 at(n % size.x, n / size.x % size.y, n / (size.x * size.y));
      Vec3 expected(0);
      for (int axis = 0; axis < 3 && counts(at); ++axis) {
        glm::ivec3 low = at, high = at;
        if (--low[axis]; !counts(low)) low = at;
        if (++high[axis]; !counts(high)) high = at;
        beside += high[axis] - low[axis] < 2 ? 1 : 0;
        if (low == high) continue;
        expected[axis] = (volume->value_at(high.x, high.y, high.z) - volume->value_at(low.x, low.y, low.z)) /
                         ((high[axis] - low[axis]) * spacing[axis]);
      }
      ASSERT_LT(glm::length(Vec3(gradients[volume->offset(at.x, at.y, at.z)]) - expected), 1e-3)
          << "seed " << seed << ", voxel " << at.x << ' ' << at.y << ' ' << at.z;
    }
    EXPECT_GT(beside, 1000);
  }
}

/// A grid that is odd in every way at once: oblique and skewed, not square, tilted, uneven.
Volume odd_volume(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto between = [&](double low, double high) { return low + (high - low) * 0.5 * (any(random) + 1); };
  const auto unit = [&] {
    const double x = any(random), y = any(random), z = any(random) + 2;
    return glm::normalize(Vec3(x, y, z));
  };
  Volume volume;
  Geometry& g = volume.geometry;
  g.dimensions = {9, 8, 10};
  g.direction_i = unit();
  g.direction_j = glm::normalize(glm::cross(unit(), g.direction_i) + 0.02 * any(random) * g.direction_i);
  g.spacing_i = between(0.4, 1.2);
  g.spacing_j = between(0.4, 1.2);
  const Vec3 normal = glm::normalize(glm::cross(g.direction_i, g.direction_j));
  Vec3 position(10 * any(random), 10 * any(random), 10 * any(random));
  for (int k = 0; k < g.dimensions.z; ++k) {
    g.slice_positions.push_back(position);
    position += between(0.5, 2.5) * normal + 0.4 * any(random) * g.direction_i + 0.4 * any(random) * g.direction_j;
  }
  g.step = (g.slice_positions.back() - g.slice_positions.front()) / (g.dimensions.z - 1.0);
  g.uniform = false;
  return volume;
}

/// Differences over two uneven intervals, weighted as they have to be, are exact for a parabola along the slices'
/// normal; weights that are swapped are not. At the ends, where one neighbour is all there is, for a linear field.
TEST(CentralDifferences, AreExactForAParabolaAcrossUnevenTiltedSkewedSlices) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    for (const double curvature : {0.0, 5.0}) {
      Volume volume = odd_volume(seed);
      const Geometry& g = volume.geometry;
      const Vec3 normal = glm::normalize(glm::cross(g.direction_i, g.direction_j));
      const Vec3 slope(3, -7, 5), origin = g.to_patient({4, 4, 5});
      std::vector<float> voxels;
      for (int k = 0; k < g.dimensions.z; ++k) {
        for (int j = 0; j < g.dimensions.y; ++j) {
          for (int i = 0; i < g.dimensions.x; ++i) {
            const Vec3 p = g.to_patient({i, j, k}) - origin;
            const double height = glm::dot(p, normal);
            voxels.push_back(static_cast<float>(glm::dot(slope, p) + curvature * height * height));
          }
        }
      }
      volume.voxels = voxels;
      volume.slope = 2;
      const auto shared = std::make_shared<const Volume>(volume);
      const auto gradients = GradientKernel(shared, GradientKernel::CentralDifferences{}).whole();
      const bool linear = curvature == 0;
      for (int k = linear ? 0 : 1; k < g.dimensions.z - (linear ? 0 : 1); ++k) {
        for (int j = 0; j < g.dimensions.y; ++j) {
          for (int i = 0; i < g.dimensions.x; ++i) {
            const double height = glm::dot(g.to_patient({i, j, k}) - origin, normal);
            const Vec3 expected = 2.0 * (slope + 2 * curvature * height * normal);
            ASSERT_LT(glm::length(Vec3(gradients[volume.offset(i, j, k)]) - expected),
                      1e-4 * (1 + glm::length(expected)))
                << seed << ": " << i << ' ' << j << ' ' << k;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
