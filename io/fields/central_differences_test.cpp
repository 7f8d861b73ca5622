// Central differences, against fields whose derivative is known at every voxel.
#include "io/fields/gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <memory>
#include <random>

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
