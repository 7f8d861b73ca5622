#include "device/safety/energy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

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

constexpr double two_pi = 2 * std::numbers::pi;

/// Hand and force swing along y, `lag` radians apart, for a second at 10 kHz from `begin_s` on. Returns the mean of the
/// energy counted in the last half of it.
double counted_j(double hz, double speed_m_per_s, double force_n, double lag, EnergyState& state, double begin_s = 0) {
  constexpr double tick_s = 1e-4;
  double sum = 0;
  for (int n = 0; n < 10000; ++n) {
    const double time = n * tick_s, phase = two_pi * hz * time;
    const Reading reading{begin_s + time, {0, speed_m_per_s / (two_pi * hz) * std::sin(phase), 0}, 0, true};
    damp_ringing({}, reading, {0, force_n * std::cos(phase - lag), 0}, state);
    if (n >= 5000) sum += state.generated / 5000;
  }
  return sum;
}

/// Force and velocity that swing together give the power F v cos(lag) / 2. Of that the first-order high passes on both
/// leave f^2 / (f^2 + corner^2), and what is forgotten over the memory settles at power times memory.
TEST(Energy, CountsThePowerInTheFastBand) {
  const EnergyLimits limits;
  for (const double hz : {6.0, 20.0, 60.0, 150.0}) {
    for (const double lag : {0.0, 1.0, std::numbers::pi}) {
      EnergyState state;
      const double share = hz * hz / (hz * hz + limits.corner * limits.corner);
      const double wanted_j = 0.5 * 0.2 * 0.6 * share * limits.memory;
      EXPECT_NEAR(counted_j(hz, 0.2, 0.6, lag, state) / wanted_j, std::cos(lag), 0.1) << hz << " Hz, " << lag;
    }
  }
}

/// A clock may count from when the machine was started.
TEST(Energy, IsTheSameWheneverItBegins) {
  EnergyState at_zero;
  const double wanted_j = counted_j(60, 0.2, 0.6, 0, at_zero);
  for (const double begin_s : {0.2, 3600.0, 1e6}) {
    EnergyState state;
    EXPECT_NEAR(counted_j(60, 0.2, 0.6, 0, state, begin_s), wanted_j, 1e-3 * wanted_j) << begin_s;
  }
}

/// What was generated is forgotten as exp(-t / memory), and all at once after a pause longer than that.
TEST(Energy, ForgetsOverItsMemory) {
  const EnergyLimits limits;
  EnergyState state;
  counted_j(100, 0.2, 0.6, 0, state);
  Reading reading{1, state.position, 0, true};
  for (int n = 0; n < 1000; ++n) {  // at rest, until nothing is left in the fast band
    reading.time += 1e-4;
    damp_ringing(limits, reading, Vec3(0), state);
  }
  const double before = state.generated;
  for (int n = 0; n < 3000; ++n) {
    reading.time += 1e-4;
    damp_ringing(limits, reading, Vec3(0), state);
  }
  EXPECT_NEAR(state.generated / before, std::exp(-3), 0.01 * std::exp(-3));
  // A long pause says nothing of how fast the hand was meanwhile, against a force from before it.
  reading.time += 1e-4;
  damp_ringing(limits, reading, Vec3(0, 5, 0), state);
  reading.time += 1.01 * limits.memory;
  reading.position.y += 0.01;
  EXPECT_EQ(damp_ringing(limits, reading, Vec3(0, 1, 0), state), Vec3(0, 1, 0));
  EXPECT_EQ(state.generated, 0);
}

/// The damping sets in at the energy that is tolerated, rises evenly, and stays at its most, however much there is. A
/// position that steps to and fro counts with less than a third of its steps' speed.
TEST(Energy, DampsInProportionUpToItsMost) {
  const EnergyLimits limits;
  constexpr double tick_s = 1e-3, step_m = 1e-5;
  for (const double part : {-3.0, 0.0, 0.25, 0.5, 1.0, 2.0, 1000.0}) {
    EnergyState state;
    Vec3 added(0);
    for (int n = 0; n < 400; ++n) {
      const Reading reading{n * tick_s, {n % 2 == 0 ? step_m : 0, 0, 0}, 0, true};
      // Without a force nothing is added to what is counted.
      state.generated = limits.tolerated + part * (limits.full_damping - limits.tolerated);
      state.generated /= 1 - tick_s / limits.memory;
      added = damp_ringing(limits, reading, Vec3(0), state);
    }
    // Of a velocity that alternates, the mean with the one before leaves a third, the slow part s / (2 - s).
    const double slow = two_pi * limits.corner * tick_s;
    const double speed = step_m / tick_s * (1.0 / 3 - slow / (2 - slow));
    const double wanted_n = limits.most_damping * std::clamp(part, 0.0, 1.0) * speed;  // the last step was back
    EXPECT_NEAR(added.x, wanted_n, 1e-3 * limits.most_damping * speed) << part;
    EXPECT_EQ(added.y, 0);
  }
}

/// Wherever the hand is when the first pose comes, it has not moved there.
TEST(Energy, TheFirstPoseIsNoMotion) {
  EnergyState state;
  const Vec3 back(-1, 0, 0);
  for (int n = 1; n <= 50; ++n) {
    const Reading reading{n * 1e-3, {0.05, 0, 0}, 0, true};
    ASSERT_EQ(damp_ringing({}, reading, back, state), back) << n;
  }
  EXPECT_EQ(state.generated, 0);
}

/// As the design has them: more damping would ring by itself.
TEST(Energy, HasTheLimitsOfTheDesign) {
  const EnergyLimits limits;
  EXPECT_EQ(limits.corner, 20);
  EXPECT_EQ(limits.memory, 0.1);
  EXPECT_EQ(limits.tolerated, 10e-6);
  EXPECT_EQ(limits.full_damping, 50e-6);
  EXPECT_EQ(limits.most_damping, 3);
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
