#include "io/fields/low_high.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "io/fields/volume_fields.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

using testdata::Grid;
using testdata::Layer;

const Vec3 inward = glm::normalize(Vec3(0.3, 1, 0.2));

std::vector<Grid> grids() {
  Grid straight;
  straight.size = {56, 56, 56};
  Grid tilted = rotated(straight, {1, 2, 3}, 40);
  tilted.tilt_degrees = 20;
  Grid thick = straight;
  thick.spacing = {0.8, 1, 2.5};
  thick.size.z = 24;
  return {straight, tilted, thick};
}

/// Shares of the voxels near a boundary whose low and high are both within a tenth of the step of its two sides, and
/// of those off by more than half the step.
struct Agreement {
  double within_tenth = 0, beyond_half = 0;
  int voxels = 0;
};

Agreement agreement(const std::vector<Layer>& layers, double boundary_mm, double low, double high, const Grid& grid,
                    double noise) {
  testdata::Acquisition acquisition;
  acquisition.noise = noise;
  const auto volume = std::make_shared<const Volume>(
      testdata::scan(testdata::make_slab(inward, layers), testdata::make_geometry(grid), acquisition));
  const double scale = default_gradient_scale_mm(volume->geometry);
  const GradientKernel kernel(volume, scale);
  Agreement result;
  kernel.for_each_block(
      [&](const Block& block, std::span<const glm::vec3> gradients) {
        std::size_t n = 0;
        for (int k = 0; k < block.size.z; ++k) {
          for (int j = 0; j < block.size.y; ++j) {
            for (int i = 0; i < block.size.x; ++i) {
              const glm::ivec3 voxel = block.first + glm::ivec3(i, j, k);
              const Vec3 gradient(gradients[n++]);
              const Vec3 place = volume->geometry.to_patient(voxel);
              if (std::abs(glm::dot(place, inward) - boundary_mm) > 0.5 * scale ||
                  glm::length(place - glm::dot(place, inward) * inward) > 15) {
                continue;
              }
              const LowHigh sides = low_high_at(*volume, voxel, gradient, scale);
              const double off = std::max(std::abs(sides.low - low), std::abs(sides.high - high)) / (high - low);
              ++result.voxels;
              result.within_tenth += off <= 0.1;
              result.beyond_half += off > 0.5;
            }
          }
        }
      },
      {}, 1);
  result.within_tenth /= result.voxels;
  result.beyond_half /= result.voxels;
  return result;
}

TEST(LowHigh, are_the_tissues_on_both_sides_of_a_flat_boundary) {
  for (const Grid& grid : grids()) {
    for (const double noise : {20.0, 0.0}) {
      if (is_sanitized && noise == 0) continue;
      const Agreement skin = agreement({{0, 40}}, 0, -1000, 40, grid, noise);
      EXPECT_GT(skin.voxels, 500);
      EXPECT_GT(skin.within_tenth, 0.99);
      const Agreement bone = agreement({{-20, 40}, {0, 1000}}, 0, 40, 1000, grid, noise);
      EXPECT_GT(bone.within_tenth, 0.99);
    }
  }
}

TEST(LowHigh, tell_the_two_faces_of_a_thin_wall_apart) {
  // Skin and skull 5 mm apart: the gradient's own kernel reaches over both.
  for (const double noise : {0.0, 20.0}) {
    const std::vector<Layer> layers{{0, 40}, {5, 1000}};
    EXPECT_GT(agreement(layers, 0, -1000, 40, grids()[0], noise).within_tenth, 0.95);
    EXPECT_GT(agreement(layers, 5, 40, 1000, grids()[0], noise).within_tenth, 0.95);
  }
}

TEST(LowHigh, of_a_sinus_wall_are_air_and_bone_although_every_soft_tissue_value_is_passed) {
  const Agreement sinus = agreement({{0, 1000}}, 0, -1000, 1000, grids()[0], 20);
  EXPECT_GT(sinus.within_tenth, 0.99);
}

/// A volume of 0.2 mm voxels along one axis, and of others along the other two, whose values depend on the place along
/// that axis alone.
Volume along(int axis, const std::function<double(double)>& value) {
  Volume volume;
  Geometry& g = volume.geometry;
  g.dimensions = glm::ivec3(3);
  g.dimensions[axis] = 61;
  Vec3 spacing(3, 1.7, 2.3);
  spacing[axis] = 0.2;
  g.spacing_i = spacing.x;
  g.spacing_j = spacing.y;
  g.step = {0, 0, spacing.z};
  for (int k = 0; k < g.dimensions.z; ++k) g.slice_positions.push_back(static_cast<double>(k) * g.step);
  std::vector<float> voxels;
  for (int k = 0; k < g.dimensions.z; ++k) {
    for (int j = 0; j < g.dimensions.y; ++j) {
      for (int i = 0; i < g.dimensions.x; ++i) {
        voxels.push_back(static_cast<float>(value(0.2 * (glm::ivec3(i, j, k)[axis] - 30))));
      }
    }
  }
  volume.voxels = std::move(voxels);
  return volume;
}

// Behind a rise of 100 a mm comes a lull, and then it rises again. The boundary ends in the lull where the slope there
// is below three tenths of the steepest, and behind it a fifth more of that; else it goes on to where it is flat.
TEST(LowHigh, end_in_a_lull_before_the_next_rise) {
  struct Case {
    double lull, again;
    bool ends;
  };
  for (const Case& c : {Case{0.25, 0.5, true},
                        {0.2, 0.45, true},
                        {0.28, 0.52, true},
                        {0.35, 0.6, false},
                        {0.32, 0.57, false},
                        {0.25, 0.4, false},
                        {0.25, 0.43, false},
                        {0.12, 0.25, false}}) {
    const auto above = [&](double x) {  // of the middle of the steepest part
      return 100 * (std::min(x, 1.0) + c.lull * std::clamp(x - 1, 0.0, 1.4) + c.again * std::clamp(x - 2.4, 0.0, 1.4));
    };
    const double flat = above(3.8), first = above(1), last = above(2.4);
    for (int axis = 0; axis < 3; ++axis) {
      SCOPED_TRACE(::testing::Message() << c.lull << ' ' << c.again << ", axis " << axis);
      Vec3 uphill(0);
      uphill[axis] = 100;
      glm::ivec3 voxel(1);
      voxel[axis] = 30;
      const Volume up = along(axis, [&](double x) { return x > 0 ? above(x) : 100 * std::max(x, -1.0); });
      const LowHigh of_up = low_high_at(up, voxel, uphill, 2);
      EXPECT_NEAR(of_up.low, -100, 1);
      // And the same the other way round.
      const Volume down = along(axis, [&](double x) { return x < 0 ? -above(-x) : 100 * std::min(x, 1.0); });
      const LowHigh of_down = low_high_at(down, voxel, uphill, 2);
      EXPECT_NEAR(of_down.high, 100, 1);
      for (const double end : {static_cast<double>(of_up.high), -static_cast<double>(of_down.low)}) {
        if (c.ends) {
          EXPECT_GE(end, first - 1);
          EXPECT_LE(end, last + 1);
        } else {
          EXPECT_NEAR(end, flat, 1);
        }
      }
    }
  }
}

// In a mirror across the slices, with the values turned round, the two sides change places: also where the slices below
// a voxel are nearer than those above.
TEST(LowHigh, change_places_in_a_mirror_whatever_the_slices) {
  constexpr int side = 24;
  int different = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    const Vec3 waves(any(0.2, 0.5), any(0.2, 0.5), any(0.2, 0.5));
    const Vec3 phases(any(0, 6), any(0, 6), any(0, 6));
    std::vector<double> heights{0};
    for (int k = 1; k < side; ++k) heights.push_back(heights.back() + (k % 2 == 0 ? any(0.6, 0.9) : any(2, 3)));
    const auto value = [&](int i, int j, double z) {
      return 300 * (std::sin(waves.x * i + phases.x) + std::sin(waves.y * j + phases.y) +
                    std::sin(waves.z * z + phases.z)) +
             40 * z;
    };
    Volume volume, mirrored;
    for (Volume* const one : {&volume, &mirrored}) {
      Geometry& g = one->geometry;
      g.dimensions = glm::ivec3(side);
      g.spacing_i = 0.8;
      g.spacing_j = 1.1;
      g.step = {0, 0, heights.back() / (side - 1)};
      g.uniform = false;
      std::vector<float> voxels;
      for (std::size_t n = 0; n < side; ++n) {
        const double z = one == &volume ? heights[n] : heights[side - 1 - n];
        g.slice_positions.emplace_back(0, 0, one == &volume ? z : -z);
        for (int j = 0; j < side; ++j) {
          for (int i = 0; i < side; ++i)
            voxels.push_back(static_cast<float>((one == &volume ? 1 : -1) * value(i, j, z)));
        }
      }
      one->voxels = std::move(voxels);
    }
    for (int n = 0; n < 20; ++n) {
      const glm::ivec3 voxel(6 + n % 11, 7 + n % 9, 8 + n % 8);
      const double scale = any(0.8, 2.5);
      const Vec3 uphill(any(-40, 40), any(-40, 40), any(30, 200));
      const LowHigh here = low_high_at(volume, voxel, uphill, scale);
      const LowHigh there =
          low_high_at(mirrored, {voxel.x, voxel.y, side - 1 - voxel.z}, {-uphill.x, -uphill.y, uphill.z}, scale);
      EXPECT_NEAR(there.low, -here.high, 1e-2) << seed << ' ' << n;
      EXPECT_NEAR(there.high, -here.low, 1e-2) << seed << ' ' << n;
      different += here.high - here.low > 50 ? 1 : 0;
    }
  }
  EXPECT_GT(different, 100);
}

TEST(LowHigh, is_the_value_itself_where_there_is_no_boundary) {
  testdata::Phantom even;
  even.background = 40;
  const Volume volume = testdata::scan(even, testdata::make_geometry(Grid{}));
  for (const Vec3& gradient : {Vec3(0), Vec3(1, 0, 0)}) {
    const LowHigh sides = low_high_at(volume, {5, 6, 63}, gradient, 2);
    EXPECT_EQ(sides.low, 40);
    EXPECT_EQ(sides.high, 40);
  }
}

TEST(LowHigh, vary_smoothly_between_voxels_and_are_those_of_the_voxels_at_their_centers) {
  const auto volume =
      std::make_shared<const Volume>(testdata::scan(testdata::make_sphere(20), testdata::make_geometry(Grid{})));
  const VolumeFields fields(volume, FieldSet::low_high, 2);
  double worst = 0;
  Sample before = fields.sample(inward * 17.0, FieldSet::low_high);
  for (int n = 1; n <= 6000; ++n) {
    const Sample here = fields.sample(inward * (17.0 + 0.001 * n), FieldSet::low_high);
    ASSERT_TRUE(here.inside);
    worst = std::max({worst, std::abs(here.low - before.low), std::abs(here.high - before.high)});
    before = here;
  }
  EXPECT_LT(worst, 4) << "HU in a micrometer";
  const GradientKernel kernel(volume, 2);
  const glm::ivec3 voxel(50, 40, 36);
  glm::vec3 gradient;
  kernel.at_cell({voxel, glm::ivec3(1)}, std::span(&gradient, 1));
  const LowHigh sides = low_high_at(*volume, voxel, Vec3(gradient), 2);
  const Sample sample = fields.sample(volume->geometry.to_patient(voxel), FieldSet::low_high);
  EXPECT_FLOAT_EQ(static_cast<float>(sample.low), sides.low);
  EXPECT_FLOAT_EQ(static_cast<float>(sample.high), sides.high);
}

// Between voxels: theirs, weighted by how near they are and by the square of the slope there.
TEST(LowHigh, of_a_cell_are_the_mean_of_its_corners_by_the_square_of_their_slopes) {
  Grid grid;
  grid.size = {40, 36, 30};
  grid.spacing = {0.9, 1.1, 1.6};
  const auto volume = std::make_shared<const Volume>(
      testdata::scan(testdata::make_sphere(12), testdata::make_geometry(grid), {.noise = 30}));
  const VolumeFields fields(volume, FieldSet::low_high, 1.8);
  const GradientKernel kernel(volume, 1.8);
  int edges = 0;
  for (int n = 0; n < 200; ++n) {
    const glm::ivec3 first(6 + 7 * n % 27, 5 + 5 * n % 25, 4 + 3 * n % 21);
    const Vec3 part(0.01 * (37 * n % 100), 0.01 * (53 * n % 100), 0.01 * (71 * n % 100));
    std::array<glm::vec3, 8> gradients;
    kernel.at_cell({first, glm::ivec3(2)}, gradients);
    double low = 0, high = 0, sum = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const glm::ivec3 side(corner % 2, corner / 2 % 2, corner / 4);
      const Vec3 share = Vec3(side) * part + (1.0 - Vec3(side)) * (1.0 - part), slope(gradients[corner]);
      const double weight = share.x * share.y * share.z * glm::dot(slope, slope);
      const LowHigh sides = low_high_at(*volume, first + side, slope, 1.8);
      low += weight * static_cast<double>(sides.low);
      high += weight * static_cast<double>(sides.high);
      sum += weight;
    }
    const Sample sample = fields.sample(volume->geometry.to_patient(Vec3(first) + part), FieldSet::low_high);
    EXPECT_NEAR(sample.low, low / sum, 1e-2) << n;
    EXPECT_NEAR(sample.high, high / sum, 1e-2) << n;
    edges += high - low > 500 * sum ? 1 : 0;
  }
  EXPECT_GT(edges, 20);
}

}  // namespace
}  // namespace palpate::io
