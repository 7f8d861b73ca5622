#include "device/safety/energy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "device/simulated/simulated_stylus.h"

namespace palpate::device {
namespace {

struct Pressed {
  double ringing = 0;  ///< m, of the last half second
  double added = 0;    ///< N, the longest damping force
};

/// Presses on a wall of the given stiffness, N/m.
Pressed press(double stiffness, double friction, bool damped) {
  SimulatedDevice device;
  device.arm.coulomb_friction = friction;
  SimulatedStylus stylus(device);
  const Waypoint path[] = {{0, {0, 0.005, 0}}, {0.5, {0, -0.002, 0}}};
  stylus.follow(path);
  stylus.open();
  EnergyState state;
  Pressed pressed;
  double lowest = 1;
  double highest = -1;
  for (int i = 0; i < 3000; ++i) {
    const Reading reading = stylus.read();
    const Vec3 wall(0, std::max(0.0, -stiffness * reading.position.y), 0);
    const Vec3 force = damp_ringing({}, reading, wall, state);
    pressed.added = std::max(pressed.added, glm::length(force - wall));
    stylus.write_force(damped ? force : wall);
    if (i >= 2500) {
      lowest = std::min(lowest, stylus.body().position.y);
      highest = std::max(highest, stylus.body().position.y);
    }
  }
  pressed.ringing = highest - lowest;
  return pressed;
}

TEST(Energy, AWallOfTheDefaultStiffnessIsLeftAlone) {
  EXPECT_EQ(press(400, 0.06, true).added, 0);
  EXPECT_EQ(press(400, 0, true).added, 0);
}

TEST(Energy, RingingIsDamped) {
  // Beyond the linear bound of 4300 N/m without friction, and beyond 7500 N/m with it.
  EXPECT_GT(press(5000, 0, false).ringing, 0.4e-3);
  EXPECT_LT(press(5000, 0, true).ringing, 0.2e-3);
  EXPECT_GT(press(8000, 0.06, false).ringing, 0.4e-3);
  EXPECT_LT(press(8000, 0.06, true).ringing, 0.1e-3);
}

TEST(Energy, DampingHasItsLimit) {
  EXPECT_LT(press(20'000, 0, true).added, 3 * 0.5);
}

TEST(Energy, ASceneMayPushTheHandSlowly) {
  // A directed force that swells in half a second moves the hand and so gives it energy; nothing is wrong with that.
  SimulatedStylus stylus;
  stylus.open();
  EnergyState state;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 push(std::min(1.0, i * 2e-3), 0, 0);
    const Vec3 force = damp_ringing({}, stylus.read(), push, state);
    ASSERT_EQ(force, push) << i;
    stylus.write_force(force);
  }
  EXPECT_GT(stylus.body().position.x, 1e-3);
}

TEST(Energy, SurvivesWhatIsNotANumber) {
  EnergyState state;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Reading reading{0, {0, 0, 0}, 0, true};
  damp_ringing({}, reading, Vec3(0), state);
  reading.time = 1e-3;
  reading.position.x = nan;
  damp_ringing({}, reading, Vec3(0), state);
  reading.time = 2e-3;
  reading.position.x = 0;
  EXPECT_TRUE(std::isnan(damp_ringing({}, reading, Vec3(nan, 0, 0), state).x)) << "the safety filter sees it";
  reading.time = 3e-3;
  EXPECT_EQ(damp_ringing({}, reading, Vec3(0, 1, 0), state), Vec3(0, 1, 0));
}

}  // namespace
}  // namespace palpate::device
