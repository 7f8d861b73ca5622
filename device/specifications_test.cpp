/// What each stylus says of itself before it is opened: its settings' limits, each under its own name, and what is
/// known of its kind.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>

#include "device/falcon/falcon.h"
#include "device/force_dimension/force_dimension.h"
#include "device/haply/haply.h"
#include "device/simulated/simulated_stylus.h"
#include "device/space_mouse/space_mouse.h"
#include "device/touch/touch.h"
#include "device/wooden_haptics/wooden_haptics.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

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

/// A kind that nobody has set anything of.
struct Known {
  std::string name;
  Vec3 half_extent_mm;
  double step_mm, force_n, lasting_n, stiffness_n_per_m;
};

void expect_known(const Stylus& stylus, const Known& known) {
  const Specification told = stylus.specification();
  EXPECT_EQ(told.name, known.name);
  EXPECT_LT(glm::distance(1e3 * told.workspace_half_extent, known.half_extent_mm), 1e-9) << known.name;
  EXPECT_NEAR(1e3 * told.position_resolution, known.step_mm, 1e-12) << known.name;
  EXPECT_DOUBLE_EQ(told.maximum_force, known.force_n) << known.name;
  EXPECT_DOUBLE_EQ(told.continuous_force, known.lasting_n) << known.name;
  EXPECT_DOUBLE_EQ(told.stiffness_limit, known.stiffness_n_per_m) << known.name;
  EXPECT_EQ(told.rate, 1000) << known.name;
}

/// Makers' figures, and what is assumed where a maker publishes none: maker by maker in the design's list of styluses.
TEST(Specifications, OfEachKindAreThePublicFigures) {
  const double cube_in_sphere = 100 / std::sqrt(3.0);  // mm, of Haply's 10 cm
  expect_known(*make_falcon({}), {"Novint Falcon", Vec3(40), 0.035, 8, 4, 1000});
  expect_known(*make_haply({}), {"Haply Inverse3", Vec3(cube_in_sphere), 0.01, 3, 1.5, 400});
  expect_known(*make_touch({}), {"3D Systems Touch", {80, 60, 35}, 0.055, 3.3, 3.3 / 4, 400});
  expect_known(*make_force_dimension({}), {"Force Dimension", Vec3(40), 0.01, 12, 12, 1500});
  expect_known(*make_wooden_haptics_on(wooden_haptics_preset("2015"), {}, {}),
               {"WoodenHaptics", Vec3(100), 0.064, 5, 2.5, 1000});
  expect_known(*make_space_mouse({}), {"SpaceMouse", {80, 60, 60}, 0.1 / 350, 0, 0, 0});
}

/// Of a Desktop PHANTOM; how stiff a wall it bears is a law of its own.
TEST(Specifications, OfTheSimulatedKindAreThoseOfItsModel) {
  for (const double rate : {1000.0, 4000.0}) {
    SimulatedDevice device;
    device.rate = rate;
    const Specification told = SimulatedStylus(device).specification();
    EXPECT_EQ(told.name, "simulated");
    EXPECT_EQ(told.workspace_half_extent, Vec3(0.08, 0.06, 0.06));
    EXPECT_EQ(told.position_resolution, 0.02e-3);
    EXPECT_EQ(told.maximum_force, 7.9);
    EXPECT_EQ(told.continuous_force, 1.75);
    EXPECT_EQ(told.rate, rate);
  }
}

TEST(Specifications, AStylusThatTellsNoRateIsServedAThousandTimesASecond) {
  EXPECT_EQ(Specification{.name = "any"}.rate, 1000);
}

}  // namespace
}  // namespace palpate::device
