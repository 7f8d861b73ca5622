/// What each stylus says of itself before it is opened: its settings' limits, each under its own name, and what is
/// known of its kind.

#include <gtest/gtest.h>

#include <memory>

#include "device/falcon/falcon.h"
#include "device/force_dimension/force_dimension.h"
#include "device/haply/haply.h"
#include "device/space_mouse/space_mouse.h"
#include "device/touch/touch.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {
namespace {

/// Of settings with these limits.
constexpr double force_n = 1.75, stiffness_n_per_m = 345;

template <typename Settings>
Settings limited() {
  Settings settings;
  settings.maximum_force = force_n;
  settings.stiffness_limit = stiffness_n_per_m;
  return settings;
}

/// The motors last at so large a part of the settings' force.
void expect_limits(const Stylus& stylus, double lasting_part, int orientation_axes = 0) {
  const Specification told = stylus.specification();
  EXPECT_EQ(told.maximum_force, force_n) << told.name;
  EXPECT_EQ(told.continuous_force, lasting_part * force_n) << told.name;
  EXPECT_EQ(told.stiffness_limit, stiffness_n_per_m) << told.name;
  EXPECT_EQ(told.position_axes, 3) << told.name;
  EXPECT_EQ(told.force_axes, 3) << told.name;
  EXPECT_EQ(told.orientation_axes, orientation_axes) << told.name;
  EXPECT_EQ(told.rate, 1000) << told.name;
  // A hand's reach, in steps finer than it feels.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(told.workspace_half_extent[axis], 0.03) << told.name;
    EXPECT_LT(told.workspace_half_extent[axis], 0.2) << told.name;
  }
  EXPECT_GT(told.position_resolution, 5e-6) << told.name;
  EXPECT_LT(told.position_resolution, 0.1e-3) << told.name;
}

TEST(Specifications, SayTheLimitsOfTheSettings) {
  expect_limits(*make_falcon(limited<FalconSettings>()), 0.5);
  expect_limits(*make_haply(limited<HaplySettings>()), 0.5);
  expect_limits(*make_touch(limited<TouchSettings>()), 0.25, 3);
  expect_limits(*make_force_dimension(limited<ForceDimensionSettings>()), 1);
}

TEST(Specifications, OfAPuckIsWhereItMayGoAndHowFineItsStepsAre) {
  const SpaceMouseSettings settings{
      .speed = 0.2, .dead_zone = 0.1, .full_deflection = 400, .half_extent = {0.05, 0.06, 0.07}};
  const Specification told = make_space_mouse(settings)->specification();
  EXPECT_EQ(told.workspace_half_extent, Vec3(0.05, 0.06, 0.07));
  EXPECT_EQ(told.force_axes, 0);
  EXPECT_EQ(told.maximum_force, 0);
  // A millisecond at the speed of one count.
  EXPECT_NEAR(told.position_resolution, 0.2 / 400 * 1e-3, 1e-15);
}

}  // namespace
}  // namespace palpate::device
