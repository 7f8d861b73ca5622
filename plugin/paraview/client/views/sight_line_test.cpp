#include "plugin/paraview/client/views/sight_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "testdata/analytic.h"

namespace palpate::plugin {
namespace {

const std::vector<OpacityNode> bone_is_opaque{{300, 0}, {500, 0.5}}, almost_nothing{{-2000, 0.001}};

TEST(SightLine, BehindABallOfBoneItIsHidden) {
  const testdata::AnalyticSource ball(testdata::make_sphere(20, testdata::bone_hu), 1);
  EXPECT_GT(hidden_part(ball, bone_is_opaque, {0, -500, 0}, {0, 30, 0}), 0.97);
  EXPECT_EQ(hidden_part(ball, bone_is_opaque, {0, -500, 0}, {0, -30, 0}), 0) << "in front of it";
  EXPECT_EQ(hidden_part(ball, bone_is_opaque, {0, -500, 0}, {30, 30, 0}), 0) << "beside it";
}

TEST(SightLine, OnItsOwnSurfaceItIsSeen) {
  const testdata::AnalyticSource ball(testdata::make_sphere(20, testdata::bone_hu), 1);
  EXPECT_LT(hidden_part(ball, bone_is_opaque, {0, -500, 0}, {0, -19, 0}), 0.01);
}

TEST(SightLine, WhatIsFaintHidesByItsThickness) {
  const std::vector<OpacityNode> faint{{-500, 0}, {0, 0.01}};
  const testdata::AnalyticSource ball(testdata::make_sphere(20, testdata::soft_tissue_hu), 1);
  // 40 mm of one part in a hundred each.
  EXPECT_NEAR(hidden_part(ball, faint, {0, -500, 0}, {0, 30, 0}), 1 - std::pow(0.99, 40), 0.02);
  EXPECT_EQ(hidden_part(ball, {}, {0, -500, 0}, {0, 30, 0}), 0);
}

TEST(SightLine, WhatIsSeenIsTheSurfaceBehindWhatIsFaint) {
  const testdata::AnalyticSource ball(testdata::make_sphere(20, testdata::bone_hu), 0.5);
  const auto seen = first_seen(ball, bone_is_opaque, {3, -500, 0}, {3, 500, 0});
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->y, -std::sqrt(20 * 20 - 3 * 3), 2) << "half of the light is taken by the first millimeters";
  EXPECT_EQ(seen->x, 3);
  EXPECT_FALSE(first_seen(ball, bone_is_opaque, {30, -500, 0}, {30, 500, 0})) << "beside it";
  EXPECT_FALSE(first_seen(ball, almost_nothing, {0, -60, 0}, {0, 60, 0})) << "air is not seen";
  EXPECT_FALSE(first_seen(ball, bone_is_opaque, {0, 0, 0}, {0, 0, 0}));
}

}  // namespace
}  // namespace palpate::plugin
