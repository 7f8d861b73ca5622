// How much of a B-spline there is along each axis.
#include "io/fields/cubic_spline.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace palpate::io
