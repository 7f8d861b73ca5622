#include "io/fields/low_high.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "io/fields/volume_fields.h"
#include "testdata/sanitized.h"
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
      if (testdata::is_sanitized && noise == 0) continue;
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

}  // namespace
}  // namespace palpate::io
