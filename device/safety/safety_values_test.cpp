/// The safety filter's numbers as they are documented, its state from the first call on, and what each of arm(),
/// disarm() and clear_fault() does to any state.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "device/safety/energy.h"
#include "device/safety/safety_filter.h"
#include "device/safety/stiffness.h"
#include "device/safety/sustained.h"
#include "device/vectors.h"

namespace palpate::device {
namespace {

/// The guide and the header have them: 3 N, 1 kN/s, half a second up and 50 ms down, 1 m/s, 10 ms, 0.1 s, 2 s.
TEST(SafetyValues, LimitsAreAsDocumented) {
  const SafetyLimits limits;
  EXPECT_EQ(limits.force, 3);
  EXPECT_EQ(limits.device_force, 12);
  EXPECT_EQ(limits.slew, 1000);
  EXPECT_EQ(limits.slew_time, 0.002);
  EXPECT_EQ(limits.ramp_time, 0.5);
  EXPECT_EQ(limits.fall_time, 0.05);
  EXPECT_EQ(limits.speed, 1);
  EXPECT_EQ(limits.speed_smoothing_time, 2e-3);
  EXPECT_EQ(limits.force_age, 0.010);
  EXPECT_EQ(limits.pose_age, 0.010);
  EXPECT_EQ(limits.stall_time, 0.1);
  EXPECT_EQ(limits.heartbeat_time, 2);
}

/// What nobody has set yet.
TEST(SafetyValues, NothingIsGivenBeforeItIsSet) {
  const SafetyInput input;
  EXPECT_EQ(input.time, 0);
  EXPECT_EQ(input.force_time, 0);
  EXPECT_EQ(input.heartbeat_time, 0);
  EXPECT_EQ(input.force, Vec3(0));
  EXPECT_EQ(input.device, State::idle);
  const SafetyResult result;
  EXPECT_EQ(result.force, Vec3(0));
  EXPECT_EQ(result.speed, 0);
  EXPECT_EQ(result.gain, 0);
  EXPECT_FALSE(result.clamped);
  EXPECT_FALSE(result.slewed);
  const SafetyState state;
  EXPECT_FALSE(state.armed);
  EXPECT_EQ(state.gain, 0);
  EXPECT_EQ(state.slewed_force, Vec3(0));
  EXPECT_EQ(state.velocity, Vec3(0));
  EXPECT_FALSE(state.has_pose);
  EXPECT_FALSE(state.started);
  const Reading reading;
  EXPECT_EQ(reading.time, 0);
  EXPECT_EQ(reading.position, Vec3(0));
  EXPECT_EQ(reading.buttons, 0U);
  EXPECT_FALSE(reading.fresh);
  EXPECT_EQ(reading.orientation, glm::dquat(1, 0, 0, 0));
  const Specification specification;
  EXPECT_EQ(specification.position_axes, 3);
  EXPECT_EQ(specification.force_axes, 3);
  EXPECT_EQ(specification.orientation_axes, 0);
  EXPECT_EQ(specification.workspace_half_extent, Vec3(0));
  EXPECT_EQ(specification.position_resolution, 0);
  EXPECT_EQ(specification.maximum_force, 0);
  EXPECT_EQ(specification.continuous_force, 0);
  EXPECT_EQ(specification.stiffness_limit, 0);
  const SustainedLimit limit;
  EXPECT_EQ(limit.continuous, 0);
  EXPECT_EQ(limit.peak, 0);
  EXPECT_EQ(limit.time, 4);
  const RenderingDynamics dynamics;
  EXPECT_EQ(dynamics.device_damping + dynamics.hand_damping + dynamics.coulomb_friction, 0);
  EXPECT_EQ(dynamics.position_step + dynamics.delay, 0);
  EXPECT_EQ(dynamics.period, 1e-3);
}

SafetyState any_state(std::mt19937& random) {
  const auto number = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  SafetyState state;
  state.armed = random() % 2 == 0;
  state.fault = static_cast<Fault>(random() % 9);
  state.gain = number();
  state.slewed_force = {number(), number(), number()};
  state.time = number();
  state.started = random() % 2 == 0;
  state.pose_time = number();
  state.has_pose = random() % 2 == 0;
  state.velocity = {number(), number(), number()};
  return state;
}

/// Whatever the state: none of the three gives a force by itself, a fault is only ever cleared by clear_fault(), and
/// that disarms, as disarm() does.
TEST(SafetyValues, ArmingAndClearingDoWhatTheySay) {
  std::mt19937 random(1);
  for (int n = 0; n < 500; ++n) {
    const SafetyState before = any_state(random);
    SafetyState armed = before, disarmed = before, cleared = before;
    const bool could = arm(armed);
    EXPECT_EQ(could, before.fault == Fault::none);
    EXPECT_EQ(armed.armed, could || before.armed);
    EXPECT_EQ(armed.fault, before.fault);
    const bool anew = could && !before.armed;
    EXPECT_EQ(armed.started, !anew && before.started);
    EXPECT_EQ(armed.has_pose, !anew && before.has_pose);
    EXPECT_EQ(armed.velocity, anew ? Vec3(0) : before.velocity);
    disarm(disarmed);
    EXPECT_FALSE(disarmed.armed);
    EXPECT_EQ(disarmed.fault, before.fault);
    clear_fault(cleared);
    EXPECT_FALSE(cleared.armed);
    EXPECT_EQ(cleared.fault, Fault::none);
    for (const SafetyState& after : {armed, disarmed, cleared}) {
      EXPECT_EQ(after.gain, before.gain);
      EXPECT_EQ(after.slewed_force, before.slewed_force);
      EXPECT_EQ(after.time, before.time);
      EXPECT_EQ(after.pose_time, before.pose_time);
    }
  }
}

/// A vector is shortened to the length, in its own direction, never beyond it, whatever its size; one that is short
/// enough is itself.
TEST(SafetyValues, AVectorIsShortenedInItsDirection) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 3000; ++n) {
    const double x = normal(random), y = normal(random), z = n % 5 == 0 ? 0 : normal(random);
    const double size = std::pow(10.0, static_cast<double>(random() % 600) - 300), longest = std::abs(normal(random));
    const Vec3 direction = glm::normalize(Vec3(x, y, z));
    const Vec3 v = size * direction, clamped = clamp_length(v, longest);
    if (size < longest * (1 - 1e-12)) {
      EXPECT_EQ(clamped, v);
    } else {
      EXPECT_LE(glm::length(clamped), longest);
      EXPECT_LT(glm::distance(clamped, longest * direction), 1e-14 * longest);
    }
  }
  EXPECT_EQ(clamp_length(Vec3(0), 1), Vec3(0));
  EXPECT_EQ(clamp_length(Vec3(1, 2, 3), 0), Vec3(0));
}

}  // namespace
}  // namespace palpate::device
