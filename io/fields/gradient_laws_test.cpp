// Limits of the gradient's kernel, and its second derivatives where they are weak.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "io/fields/gradient.h"
#include "io/fields/slice_kernel.h"

namespace palpate::io {
namespace {

/// Oblique, not square, tilted by up to 40 degrees to either side, with slices that are uneven.
Geometry leaning_grid(unsigned seed) {
  std::mt19937 random(seed);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  Geometry g;
  g.dimensions = {90, 80, seed % 2 == 0 ? 90 : 7};
  g.direction_i = glm::normalize(Vec3(1, any(-0.5, 0.5), any(-0.5, 0.5)));
  g.direction_j = glm::normalize(glm::cross(Vec3(any(-0.3, 0.3), any(-0.3, 0.3), 1), g.direction_i));
  g.spacing_i = any(0.3, 3);
  g.spacing_j = any(0.3, 3);
  const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
  const double apart = any(0.1, 6), lean_i = any(-0.8, 0.8), lean_j = any(-0.8, 0.8);
  Vec3 position(-20, 30, 40);
  for (int k = 0; k < g.dimensions.z; ++k) {
    g.slice_positions.push_back(position);
    position += apart * any(0.7, 1.3) * (normal + lean_i * g.direction_i + lean_j * g.direction_j);
  }
  g.step = (g.slice_positions.back() - g.slice_positions.front()) / (g.dimensions.z - 1.0);
  g.uniform = false;
  return g;
}

TEST(GradientScale, TheLargestIsOneThatAKernelHasRoomFor) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Geometry g = leaning_grid(seed);
    const double largest = largest_gradient_scale_mm(g);
    EXPECT_GT(largest, 0) << seed;
    EXPECT_NO_THROW(internal::make_slice_kernel(g, largest)) << seed;
    EXPECT_LE(default_gradient_scale_mm(g), largest) << seed;
  }
}

// 63 voxels of the finer spacing, of which 3.2 standard deviations have to fit in; nor may 65 slices.
TEST(GradientScale, OfAStraightGridIsWhatItsVoxelsLeaveRoomFor) {
  Geometry g;
  g.dimensions = {4, 4, 200};
  g.spacing_i = 0.8;
  g.spacing_j = 0.5;
  g.step = {0, 0, 1};
  for (int k = 0; k < 200; ++k) g.slice_positions.emplace_back(0, 0, k);
  EXPECT_DOUBLE_EQ(largest_gradient_scale_mm(g), 63 * 0.5 / 3.2);
  EXPECT_THROW(internal::make_slice_kernel(g, 63 * 0.5 / 3.2 + 1e-6), std::invalid_argument);
  std::swap(g.spacing_i, g.spacing_j);
  EXPECT_DOUBLE_EQ(largest_gradient_scale_mm(g), 63 * 0.5 / 3.2);
  for (Vec3& position : g.slice_positions) position *= 0.1;
  g.step *= 0.1;
  EXPECT_NEAR(largest_gradient_scale_mm(g), 65 * 0.1 / 3.2, 0.01);
  EXPECT_THROW(internal::make_slice_kernel(g, 65 * 0.1 / 3.2 + 0.001), std::invalid_argument);
}

// The default: 1.5 mm at least, 2 voxels of the coarser spacing, six tenths of the least distance between slices.
TEST(GradientScale, OfItselfFollowsTheCoarsestOfThree) {
  const auto scale_of = [](double i, double j, const std::vector<double>& steps) {
    Geometry g;
    g.dimensions = {4, 4, static_cast<int>(steps.size()) + 1};
    g.spacing_i = i;
    g.spacing_j = j;
    Vec3 position(0);
    g.slice_positions = {position};
    for (const double step : steps) g.slice_positions.push_back(position += Vec3(0, 0.3 * step, step));
    g.step = position / static_cast<double>(steps.size());
    return default_gradient_scale_mm(g);
  };
  EXPECT_DOUBLE_EQ(scale_of(0.7, 0.6, {1, 1, 1}), 1.5);
  EXPECT_DOUBLE_EQ(scale_of(0.8, 0.6, {1, 1, 1}), 1.6);
  EXPECT_DOUBLE_EQ(scale_of(0.6, 0.9, {1, 1, 1}), 1.8);
  EXPECT_DOUBLE_EQ(scale_of(0.6, 0.6, {4, 3, 4}), 1.8) << "the least distance, along the normal";
}

TEST(GradientScale, OfCentralDifferencesIsHalfOfWhatTheySpan) {
  for (const Vec3& spacing : {Vec3(0.5, 0.7, 2), Vec3(3, 0.7, 2), Vec3(0.5, 2.5, 2)}) {
    auto volume = std::make_shared<Volume>();
    Geometry& g = volume->geometry;
    g.dimensions = {2, 2, 2};
    g.spacing_i = spacing.x;
    g.spacing_j = spacing.y;
    g.step = {0, 0.4, spacing.z};
    g.slice_positions = {Vec3(0), g.step};
    volume->voxels = std::vector<float>(8);
    const GradientKernel kernel(volume, GradientKernel::CentralDifferences{});
    EXPECT_DOUBLE_EQ(kernel.scale_mm(), std::max({spacing.x, spacing.y, spacing.z}));
    EXPECT_EQ(kernel.radius(), glm::ivec3(1));
  }
}

// Unknown where a slice of the neighborhood is missing, at either end of the stack; known where all of it is there.
TEST(SecondDerivatives, AreKnownWhereTheWholeNeighborhoodIsInTheScan) {
  for (const double lean : {0.0, 0.3}) {
    for (const double apart : {0.8, 1.2, 2.0}) {
      auto volume = std::make_shared<Volume>();
      Geometry& g = volume->geometry;
      const glm::ivec3 size(21, 20, 17);
      g.dimensions = size;
      g.spacing_i = 0.7;
      g.spacing_j = 0.8;
      g.step = {0, lean, apart};
      for (int k = 0; k < size.z; ++k) g.slice_positions.push_back(static_cast<double>(k) * g.step);
      std::mt19937 random(5);
      std::vector<float> voxels;
      for (int n = 0; n < size.x * size.y * size.z; ++n) {
        voxels.push_back(std::uniform_real_distribution<float>(0, 1000)(random));
      }
      volume->voxels = std::move(voxels);
      const GradientKernel kernel(volume, 1);
      const glm::ivec3 reach = kernel.radius();
      std::vector<GradientKernel::Hessian> found(static_cast<std::size_t>(size.x * size.y * size.z));
      kernel.hessians_at_block({glm::ivec3(0), size}, found);
      int known = 0;
      auto hessian = found.begin();
      for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; ++j) {
          for (int i = 0; i < size.x; ++i, ++hessian) {
            const bool all_slices = k >= reach.z && k + reach.z < size.z;
            const bool all_there =
                all_slices && i >= reach.x && i + reach.x < size.x && j >= reach.y && j + reach.y < size.y;
            const bool is_known = std::isfinite((*hessian)[0]);
            if (all_there) {
              ASSERT_TRUE(is_known) << i << ' ' << j << ' ' << k;
            }
            if (!all_slices || (lean == 0 && !all_there)) {
              ASSERT_FALSE(is_known) << i << ' ' << j << ' ' << k;
            }
            known += is_known ? 1 : 0;
          }
        }
      }
      EXPECT_GT(known, 500);
    }
  }
}

// A curvature that changes values by a ten-thousandth over the kernel is still felt.
TEST(SecondDerivativesOfAParabola, AreThoseOfItsMatrixHoweverWeak) {
  const glm::dmat3 curved(0.030, 0.008, -0.005, 0.008, -0.022, 0.006, -0.005, 0.006, 0.018);
  for (const double weak : {1.0, 100.0}) {
    auto volume = std::make_shared<Volume>();
    Geometry& g = volume->geometry;
    g.dimensions = {27, 25, 15};
    g.direction_i = glm::normalize(Vec3(1, 0.3, -0.2));
    g.direction_j = glm::normalize(glm::cross(Vec3(0.2, -0.1, 1), g.direction_i));
    g.spacing_i = 0.7;
    g.spacing_j = 0.8;
    g.step = 1.2 * glm::cross(g.direction_i, g.direction_j) + 0.3 * g.direction_j;
    for (int k = 0; k < 15; ++k) g.slice_positions.push_back(static_cast<double>(k) * g.step);
    const Vec3 middle = g.to_patient({13, 12, 7});
    std::vector<float> voxels;
    for (int k = 0; k < 15; ++k) {
      for (int j = 0; j < 25; ++j) {
        for (int i = 0; i < 27; ++i) {
          const Vec3 at = g.to_patient({i, j, k}) - middle;
          voxels.push_back(static_cast<float>(1000 / weak + 0.5 * glm::dot(at, curved * at)));
        }
      }
    }
    volume->voxels = std::move(voxels);
    std::array<GradientKernel::Hessian, 1> found{};
    GradientKernel(volume, 1.6).hessians_at_cell({{13, 12, 7}, {1, 1, 1}}, found);
    const std::array expected{curved[0][0], curved[1][0], curved[1][1], curved[2][0], curved[2][1], curved[2][2]};
    for (std::size_t n = 0; n < 6; ++n) {
      EXPECT_NEAR(static_cast<double>(found[0][n]), expected[n], 0.0025) << n << ", " << weak;
    }
  }
}

}  // namespace
}  // namespace palpate::io
