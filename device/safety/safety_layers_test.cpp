/// Each layer of the safety filter alone, with all others out of the way, reached to the tick: a layer that another one
/// stands in for is a layer that nobody tests.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <utility>

#include "device/safety/safety_filter.h"
#include "device/testing/filter_session.h"

namespace palpate::device {
namespace {

TEST(SafetyLayers, WithoutLimitsTheForceGoesThrough) {
  std::mt19937 random(1);
  FilterSession session;
  session.push(Vec3(1, 2, 3));
  for (int n = 0; n < 100; ++n) {
    session.input.force = any_force(random, 0, 1e6);
    const SafetyResult result = session.step();
    EXPECT_EQ(result.force, session.input.force);
    EXPECT_FALSE(result.clamped);
    EXPECT_FALSE(result.slewed);
  }
}

/// Also of forces whose squares are no numbers. The device's limit is the last of all: on the ramp it cuts what the
/// ramp has left.
TEST(SafetyLayers, TheForceLimitAlone) {
  std::mt19937 random(2);
  for (const bool of_device : {false, true}) {
    FilterSession session;
    session.push(Vec3(0, 1, 0));
    (of_device ? session.limits.device_force : session.limits.force) = 2.5;
    session.limits.slew = 1e308;
    for (int n = 0; n < 200; ++n) {
      session.limits.ramp_time = n < 100 ? 1e-9 : 0.05;
      if (n % 50 == 0) {  // along the ramp once more
        disarm(session.state);
        session.step();
        arm(session.state);
        session.step();
      }
      const Vec3 direction = any_force(random, 1, 1);
      const double length = n % 5 == 0 ? 1e300 : std::uniform_real_distribution<double>(0.1, 5)(random);
      session.input.force = length * direction;
      const SafetyResult result = session.step();
      const double expected = of_device ? std::min(result.gain * length, 2.5) : result.gain * std::min(length, 2.5);
      EXPECT_LT(glm::distance(result.force, expected * direction), 1e-12);
      EXPECT_EQ(result.clamped, (of_device ? result.gain * length : length) > 2.5);
    }
  }
}

TEST(SafetyLayers, TheSlewAlone) {
  std::mt19937 random(3);
  FilterSession session;
  session.push(Vec3(1, 0, 0));
  session.limits.slew = 300;
  Vec3 before(1, 0, 0);
  int reached = 0;
  for (int n = 0; n < 500; ++n) {
    session.input.force = n % 20 < 10 ? any_force(random, 0, 3) : session.input.force;
    const double elapsed = n % 3 == 0 ? 2 * tick : tick;
    const SafetyResult result = session.step(elapsed);
    const double wanted = glm::length(session.input.force - before);
    EXPECT_NEAR(glm::length(result.force - before), std::min(wanted, 300 * elapsed), 1e-9);
    // Straight towards what is asked for.
    EXPECT_NEAR(glm::length(session.input.force - result.force), std::max(0.0, wanted - 300 * elapsed), 1e-9);
    EXPECT_EQ(result.slewed, wanted > 300 * elapsed);
    reached += result.slewed ? 1 : 0;
    before = result.force;
  }
  EXPECT_GT(reached, 100);
}

/// The slew is by the clock, but not by time that was missed: with the limits of a session, a tick that is late by 9 or
/// by 90 ms must not give all of 3 N at once.
TEST(SafetyLayers, ALateTickMovesTheForceNoFartherThanTheLongestStep) {
  const SafetyLimits defaults;
  for (const auto& [slew, slew_time] : {std::pair{50.0, 0.010}, std::pair{defaults.slew, defaults.slew_time}}) {
    for (const double late : {0.003, 0.009, 0.011, 0.05, 0.099, 5.0}) {
      FilterSession session;
      session.push(Vec3(0));
      session.limits.slew = slew;
      session.limits.slew_time = slew_time;
      session.input.force = Vec3(0, 0, 3);
      const SafetyResult result = session.step(late);
      EXPECT_EQ(result.fault, Fault::none);
      EXPECT_NEAR(result.force.z, slew * std::min(late, slew_time), 1e-12) << late;
    }
  }
}

/// However late a tick comes, the gain moves no farther than in 10 ms: a fiftieth of the force in a ramp of half a
/// second, and a fifth in a fall of 50 ms.
TEST(SafetyLayers, ALateTickIsNoStepOfTheGain) {
  std::mt19937 random(4);
  for (int n = 0; n < 300; ++n) {
    const double late = std::uniform_real_distribution<double>(0.011, 0.099)(random);
    const int after = static_cast<int>(random() % 30);  // ticks of the ramp, or of the fall
    for (const bool falls : {false, true}) {
      FilterSession session;
      session.limits = {};
      session.input.force = any_force(random, 0.5, 3);
      session.step();
      arm(session.state);
      for (int ms = 0; ms < (falls ? 600 : after); ++ms) session.step();
      if (falls) disarm(session.state);
      for (int ms = 0; ms < (falls ? after : 0); ++ms) session.step();
      const double before = session.step().gain;
      const SafetyResult result = session.step(late);
      EXPECT_EQ(result.fault, Fault::none);
      ASSERT_LE(std::abs(result.gain - before), (falls ? 1.0 / 5 : 1.0 / 50) + 1e-9) << late;
    }
  }
}

TEST(SafetyLayers, TheRampAloneUpAndDown) {
  FilterSession session;
  session.push(Vec3(0, 2, 0));
  session.limits.ramp_time = 0.3;
  session.limits.fall_time = 0.02;
  disarm(session.state);
  for (int n = 1; n <= 25; ++n) {
    const SafetyResult result = session.step();
    EXPECT_NEAR(result.force.y, 2 * std::max(0.0, 1 - n * tick / 0.02), 1e-9) << n;
    EXPECT_EQ(result.state, State::idle);
  }
  arm(session.state);
  session.step();  // from here on ages count
  for (int n = 1; n <= 320; ++n) {
    const SafetyResult result = session.step();
    EXPECT_NEAR(result.gain, std::min(1.0, n * tick / 0.3), 1e-9) << n;
    EXPECT_NEAR(result.force.y, 2 * result.gain, 1e-9) << n;
    EXPECT_EQ(result.state, result.gain < 1 ? State::ramping : State::active);
  }
}

/// A pose that is not renewed gives no force once it is pose_age old, in that very tick; and a force likewise.
TEST(SafetyLayers, OldPosesAndOldForcesAlone) {
  for (const bool of_pose : {true, false}) {
    FilterSession session;
    session.push(Vec3(0, 1, 0));
    (of_pose ? session.limits.pose_age : session.limits.force_age) = 0.010;
    (of_pose ? session.new_pose : session.new_force) = false;
    for (int n = 1; n <= 30; ++n) {
      const SafetyResult result = session.step();
      EXPECT_EQ(result.fault, Fault::none);
      if (n * tick < 0.0095) {
        EXPECT_EQ(result.force, Vec3(0, 1, 0)) << n;
      }
      if (n * tick > 0.0105) {
        EXPECT_EQ(result.force, Vec3(0)) << n;
      }
    }
    (of_pose ? session.new_pose : session.new_force) = true;
    EXPECT_EQ(session.step().force, Vec3(0, 1, 0)) << "and it comes back";
  }
}

/// With the limits of a session: a pose or force that is late by less than its age changes nothing; the force has left
/// after that age and the time that the slew takes; and what comes back does so along the ramp.
TEST(SafetyLayers, AShortStallIsForgivenAlongTheRamp) {
  for (const bool of_pose : {true, false}) {
    FilterSession session = FilterSession::with_defaults(Vec3(0, 3, 0));
    arm(session.state);
    session.run(0.6);
    const SafetyLimits& limits = session.limits;
    const double age = of_pose ? limits.pose_age : limits.force_age;
    (of_pose ? session.new_pose : session.new_force) = false;
    for (int n = 1; n <= 90; ++n) {
      const SafetyResult result = session.step();
      ASSERT_EQ(result.fault, Fault::none);
      if (n * tick < age - tick / 2) {
        ASSERT_EQ(result.force, Vec3(0, 3, 0)) << n << " ms";
      }
      if (n * tick > age + 3 / limits.slew + 1.5 * tick) {
        ASSERT_EQ(result.force, Vec3(0)) << n << " ms";
      }
    }
    (of_pose ? session.new_pose : session.new_force) = true;
    for (int n = 1; n <= 400; ++n) {
      const double force = session.step().force.y;
      ASSERT_LE(force, 3 * n * tick / limits.ramp_time + 1e-9);
      ASSERT_GE(force, std::min(1.0 * n - 1, 3 * (n - 1) * tick / limits.ramp_time) - 1e-9) << n;
    }
  }
}

}  // namespace
}  // namespace palpate::device
