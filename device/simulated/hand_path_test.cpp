#include "device/simulated/hand_path.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace palpate::device {
namespace {

TEST(HandPath, MinimumJerkStartsAndEndsAtRest) {
  const Waypoint path[] = {{1, {0, 0, 0}, 2}, {3, {1, 0, 0}}};
  check_path(path);
  const auto x = [&](double t) { return point_on(path, PathInterpolation::minimum_jerk, t).position.x; };
  EXPECT_EQ(x(0), 0);
  EXPECT_EQ(x(3), 1);
  EXPECT_EQ(x(9), 1);
  EXPECT_DOUBLE_EQ(x(2), 0.5);
  EXPECT_NEAR((x(1.01) - x(1)) / 0.01, 0, 1e-3);
  EXPECT_NEAR((x(2.001) - x(1.999)) / 0.002, 1.875 / 2, 1e-5) << "peak speed is 15/8 of the mean";
  EXPECT_DOUBLE_EQ(point_on(path, PathInterpolation::linear, 1.5).position.x, 0.25);
  EXPECT_EQ(point_on(path, PathInterpolation::linear, 1.5).buttons, 2U);
}

TEST(HandPath, RefusesTimesThatDoNotIncrease) {
  const Waypoint path[] = {{0, {0, 0, 0}}, {1, {0, 0, 0}}, {1, {0, 0, 0}}};
  try {
    check_path(path);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "waypoint 3 of the hand's path is not later than the one before it");
  }
  EXPECT_THROW(check_path({}), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::device
