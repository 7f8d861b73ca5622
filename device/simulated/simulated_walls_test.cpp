// Walls that are felt with the simulated stylus: up to which stiffness they are quiet.
#include <gtest/gtest.h>

#include <algorithm>

#include "device/simulated/simulated_stylus.h"

namespace palpate::device {
namespace {

/// Presses on a wall of the given stiffness (N/m) at y = 0 and returns how far it still moves after two seconds, m.
double ringing(const SimulatedDevice& device, double stiffness) {
  SimulatedStylus stylus(device);
  const Waypoint path[] = {{0, {0, 0.005, 0}}, {0.5, {0, -0.002, 0}}};
  stylus.follow(path);
  stylus.open();
  double lowest = 1;
  double highest = -1;
  for (int i = 0; i < 3000; ++i) {
    const double y = stylus.read().position.y;
    stylus.write_force(Vec3(0, y < 0 ? -stiffness * y : 0, 0));
    if (i >= 2500) {
      lowest = std::min(lowest, stylus.body().position.y);
      highest = std::max(highest, stylus.body().position.y);
    }
  }
  return highest - lowest;
}

TEST(SimulatedWalls, OfTheDefaultStiffnessAreQuiet) {
  SimulatedDevice still;
  still.hand.tremor_rms = 0;
  EXPECT_LT(ringing(still, 400), 1e-9);
  EXPECT_LT(ringing(SimulatedDevice{}, 400), 0.15e-3) << "tremor alone";
}

TEST(SimulatedWalls, RingAboveTheLinearBoundWithoutFriction) {
  // Colgate and Schenkel with the hand's damping: (0.3 + 4) / (0.5 ms + 0.5 ms) = 4300 N/m.
  SimulatedDevice device;
  device.hand.tremor_rms = 0;
  device.position_step = 0;
  device.arm.coulomb_friction = 0;
  EXPECT_LT(ringing(device, 0.85 * 4300), 1e-5);
  EXPECT_GT(ringing(device, 1.15 * 4300), 0.2e-3);
}

TEST(SimulatedWalls, FrictionQuietensThemUpToItsOwnBound) {
  // Diolaiti et al.: 2 x 0.06 N / 0.02 mm = 6000 N/m near rest; found here with tremor between 7000 and 8500 N/m.
  EXPECT_LT(ringing(SimulatedDevice{}, 5900), 0.05e-3);
  EXPECT_GT(ringing(SimulatedDevice{}, 8500), 0.2e-3);
}

TEST(SimulatedWalls, TheAdvisedStiffnessIsBelowEveryBound) {
  const double advised = SimulatedStylus().specification().stiffness_limit;
  EXPECT_GT(advised, 2000);
  EXPECT_LT(advised, 3000);
  SimulatedDevice frictionless;
  frictionless.arm.coulomb_friction = 0;
  EXPECT_DOUBLE_EQ(SimulatedStylus(frictionless).specification().stiffness_limit, 300) << "b / (T/2 + t_d) alone";
}

}  // namespace
}  // namespace palpate::device
