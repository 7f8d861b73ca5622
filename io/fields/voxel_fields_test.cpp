#include "io/fields/voxel_fields.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "io/fields/volume_fields.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

using testdata::Grid;

std::vector<std::shared_ptr<const Volume>> scans() {
  testdata::Phantom ball = testdata::make_sphere(8);
  ball.bodies.push_back(testdata::make_sphere(4, testdata::bone_hu).bodies.front());
  const Grid straight{.size = {17, 15, 13}, .spacing = {1, 1.2, 2}};
  Grid uneven = rotated(straight, {1, 2, 3}, 40);
  uneven.tilt_degrees = 17;
  uneven.uneven_mm = 0.4;
  uneven.missing = {5};
  std::vector<std::shared_ptr<const Volume>> made;
  for (const Grid& grid : {straight, uneven, Grid{.size = {12, 9, 1}}}) {
    made.push_back(std::make_shared<Volume>(testdata::scan(ball, make_geometry(grid), {.noise = 30})));
  }
  made.push_back(std::make_shared<Volume>(
      testdata::scan(ball, make_geometry(straight), {.noise = 30, .circle_radius = 7})));  // with padding
  Volume of_floats = testdata::scan(ball, make_geometry(straight), {.noise = 30, .quantised = false});
  std::get<std::vector<float>>(of_floats.voxels)[of_floats.offset(8, 7, 6)] = std::numeric_limits<float>::quiet_NaN();
  made.push_back(std::make_shared<Volume>(std::move(of_floats)));
  return made;
}

TEST(VoxelFields, AreThoseSampledAtTheVoxelsCentersToTheLastBit) {
  std::size_t inside = 0, outside = 0, between = 0;
  for (const auto& volume : scans()) {
    const std::vector<glm::vec3> gradients = GradientKernel(volume, 2).whole();
    for (const ValueMethod method : {ValueMethod::cubic, ValueMethod::trilinear}) {
      const VoxelFields at_voxels(*volume, method, 2);
      constexpr FieldSet wanted = FieldSet::value | FieldSet::low_high;
      const VolumeFields sampled(volume, wanted, 2, {.value = method, .brick_bytes = 0});
      for (std::size_t n = 0; n < gradients.size(); ++n) {
        const glm::ivec3 size = volume->geometry.dimensions;
        const auto at = static_cast<int>(n);
        const glm::ivec3 voxel(at % size.x, at / size.x % size.y, at / size.x / size.y);
        const Sample sample = sampled.sample(volume->geometry.to_patient(voxel), wanted);
        const auto value = at_voxels.value(voxel);
        ASSERT_EQ(value.has_value(), sample.inside) << at;
        ++(sample.inside ? inside : outside);
        if (!sample.inside) continue;
        ASSERT_EQ(*value, sample.value) << at;
        const LowHigh sides = at_voxels.low_high(voxel, gradients[n]);
        ASSERT_EQ(sides.low, sample.low) << at;
        ASSERT_EQ(sides.high, sample.high) << at;
        between += sides.high > sides.low + 500 ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(inside, 10'000U);
  EXPECT_GT(outside, 100U);
  EXPECT_GT(between, 1000U);
}

}  // namespace
}  // namespace palpate::io
