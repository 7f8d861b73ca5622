// The B-spline's part along each axis, and values and gradients for any rescale slope.
#include "io/fields/cubic_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "io/fields/volume_fields.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

// All of it along the finest axis; along others the square of the ratio. Of slices the whole step counts, tilt and all.
TEST(CubicSpline, IsABSplineAlongTheFinestAxis) {
  Geometry geometry;
  geometry.spacing_i = 0.5;
  geometry.spacing_j = 0.8;
  geometry.step = {0.3, 0.4, 1.2};  // 1.3 mm long
  const Vec3 fine_i = b_spline_part(geometry);
  EXPECT_DOUBLE_EQ(fine_i.x, 1);
  EXPECT_DOUBLE_EQ(fine_i.y, 0.25 / 0.64);
  EXPECT_DOUBLE_EQ(fine_i.z, 0.25 / 1.69);
  geometry.step = {0, 0, 0.25};
  const Vec3 fine_k = b_spline_part(geometry);
  EXPECT_DOUBLE_EQ(fine_k.x, 0.25);
  EXPECT_DOUBLE_EQ(fine_k.y, 0.0625 / 0.64);
  EXPECT_DOUBLE_EQ(fine_k.z, 1);
}

/// The same values: in steps of another size, as whole numbers and as floats.
TEST(CubicSpline, HasTheValuesAndGradientsOfTheUnitInWhateverStepsTheyAreStored) {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  testdata::Grid grid;
  grid.size = {9, 8, 7};
  grid.spacing = {0.7, 0.9, 1.6};
  for (const double uneven_mm : {0.0, 0.2}) {
    grid.uneven_mm = uneven_mm;
    const Geometry geometry = testdata::make_geometry(grid);
    std::vector<std::int16_t> stored;
    for (int n = 0; n < 9 * 8 * 7; ++n) stored.push_back(static_cast<std::int16_t>(between(-1000, 1000)));
    for (const double slope : {0.03125, 2.0, -4.0}) {
      Volume in_steps, in_unit;
      in_steps.geometry = in_unit.geometry = geometry;
      in_steps.voxels = stored;
      in_steps.slope = slope;
      in_steps.intercept = -7;
      std::vector<float> values;
      for (const std::int16_t one : stored) values.push_back(static_cast<float>(slope * one - 7));
      in_unit.voxels = values;
      const FieldOptions options{.gradient = GradientMethod::cubic, .brick_bytes = 0};
      const FieldSet wanted = FieldSet::value | FieldSet::gradient;
      const VolumeFields steps(std::make_shared<const Volume>(in_steps), wanted, 1, options);
      const VolumeFields unit(std::make_shared<const Volume>(in_unit), wanted, 1, options);
      for (int n = 0; n < 100; ++n) {
        const Vec3 at = geometry.to_patient({between(0, 8), between(0, 7), between(0, 6)});
        const Sample a = steps.sample(at, wanted), b = unit.sample(at, wanted);
        ASSERT_TRUE(a.inside);
        const double size = 1000 * std::abs(slope);
        EXPECT_NEAR(a.value, b.value, 1e-6 * size);
        EXPECT_LT(glm::distance(a.gradient, b.gradient), 1e-6 * size) << slope;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
