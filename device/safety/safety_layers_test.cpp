/// Each layer of the safety filter alone, with all others out of the way, reached to the tick: a layer that another one
/// stands in for is a layer that nobody tests.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

#include "device/safety/safety_filter.h"
#include "device/vectors.h"

namespace palpate::device {
namespace {

constexpr double tick = 1e-3;

/// Nothing limits: what comes in goes out, as soon as the filter is armed.
SafetyLimits without_limits() {
  return {.force = 1e9,
          .device_force = 1e9,
          .slew = 1e12,
          .slew_time = 1e9,
          .ramp_time = 1e-9,
          .fall_time = 1e-9,
          .speed = 1e9,
          .force_age = 1e9,
          .pose_age = 1e9,
          .stall_time = 1e9,
          .heartbeat_time = 1e9};
}

struct Session {
  SafetyLimits limits = without_limits();
  SafetyState state;
  SafetyInput input;
  bool new_pose = true, new_force = true, alive = true;

  SafetyResult step(double elapsed = tick) {
    input.time += elapsed;
    input.reading.fresh = new_pose;
    if (new_force) input.force_time = input.time;
    if (alive) input.heartbeat_time = input.time;
    return filter_force(limits, input, state);
  }
  /// Armed, and pushing with all of the force asked for.
  void push(const Vec3& force) {
    input.force = force;
    step();
    arm(state);
    step();
    ASSERT_LT(glm::length(step().force - force), 1e-12) << "something limits that should not";
  }
};

Vec3 any_force(std::mt19937& random, double least, double most) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(Vec3(x, y, z)) * std::uniform_real_distribution<double>(least, most)(random);
}

TEST(SafetyLayers, WithoutLimitsTheForceGoesThrough) {
  std::mt19937 random(1);
  Session session;
  session.push(Vec3(1, 2, 3));
  for (int n = 0; n < 100; ++n) {
    session.input.force = any_force(random, 0, 1e6);
    const SafetyResult result = session.step();
    EXPECT_EQ(result.force, session.input.force);
    EXPECT_FALSE(result.clamped);
    EXPECT_FALSE(result.slewed);
  }
}

TEST(SafetyLayers, TheForceLimitAlone) {
  std::mt19937 random(2);
  for (const bool of_device : {false, true}) {
    Session session;
    session.push(Vec3(0, 1, 0));
    (of_device ? session.limits.device_force : session.limits.force) = 2.5;
    for (int n = 0; n < 200; ++n) {
      session.input.force = any_force(random, 0.1, 5);
      const double length = glm::length(session.input.force);
      const SafetyResult result = session.step();
      EXPECT_NEAR(glm::length(result.force), std::min(length, 2.5), 1e-12);
      EXPECT_LT(glm::length(glm::cross(result.force, session.input.force)), 1e-12) << "the direction is kept";
      EXPECT_GT(glm::dot(result.force, session.input.force), 0);
      EXPECT_EQ(result.clamped, length > 2.5);
    }
  }
}

TEST(SafetyLayers, TheSlewAlone) {
  std::mt19937 random(3);
  Session session;
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

/// The slew is by the clock, but not by time that was missed.
TEST(SafetyLayers, ALateTickMovesTheForceNoFartherThanTheLongestStep) {
  for (const double late : {0.011, 0.05, 0.099, 5.0}) {
    Session session;
    session.push(Vec3(0));
    session.limits.slew = 50;
    session.limits.slew_time = 0.010;
    session.input.force = Vec3(0, 0, 3);
    const SafetyResult result = session.step(late);
    EXPECT_EQ(result.fault, Fault::none);
    EXPECT_NEAR(result.force.z, 50 * 0.010, 1e-12) << late;
  }
}

/// With the limits of a session, the force is 3 N and slews by 1 N in a tick of 1 ms: a tick that is late by 9 or 90
/// must not give all three at once.
TEST(SafetyLayers, ALateTickIsNoStepWithTheDefaultLimits) {
  for (const double late : {0.004, 0.009, 0.05, 0.09}) {
    Session session;
    session.push(Vec3(0));
    const SafetyLimits defaults;
    session.limits.force = defaults.force;
    session.limits.slew = defaults.slew;
    session.limits.slew_time = defaults.slew_time;
    session.input.force = Vec3(0, 0, 3);
    const SafetyResult result = session.step(late);
    EXPECT_EQ(result.fault, Fault::none);
    EXPECT_GT(result.force.z, 0.5);
    EXPECT_LE(result.force.z, 2.0 + 1e-12) << late;
  }
}

TEST(SafetyLayers, TheRampAloneUpAndDown) {
  Session session;
  session.push(Vec3(0, 2, 0));
  session.limits.ramp_time = 0.3;
  session.limits.fall_time = 0.02;
  disarm(session.state);
  for (int n = 1; n <= 25; ++n) {
    EXPECT_NEAR(session.step().force.y, 2 * std::max(0.0, 1 - n * tick / 0.02), 1e-9) << n;
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
    Session session;
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

/// A session's own limits: on a dead pose the force has left after pose_age and the time that the slew takes.
TEST(SafetyLayers, ADeadPoseHoldsNoForceForLongerThanItsAge) {
  Session session;
  session.limits = {};
  session.input.force = Vec3(0, 3, 0);
  session.step();
  arm(session.state);
  for (int n = 0; n < 600; ++n) session.step();
  session.new_pose = false;
  for (int n = 1; n <= 90; ++n) {
    const SafetyResult result = session.step();
    if (n * tick > session.limits.pose_age + 3 / session.limits.slew + 1.5 * tick) {
      ASSERT_EQ(result.force, Vec3(0)) << n << " ms";
    }
  }
}

struct Stall {
  Fault fault;
  double SafetyLimits::*limit;
  bool Session::*what;
};

/// Each stall alone, to the tick.
TEST(SafetyLayers, EachStallAloneIsItsOwnFault) {
  for (const Stall& stall : {Stall{Fault::device_silent, &SafetyLimits::stall_time, &Session::new_pose},
                             Stall{Fault::force_stale, &SafetyLimits::stall_time, &Session::new_force},
                             Stall{Fault::commander_silent, &SafetyLimits::heartbeat_time, &Session::alive}}) {
    Session session;
    session.push(Vec3(0, 1, 0));
    session.limits.*stall.limit = 0.1005;
    session.*stall.what = false;
    for (int n = 1; n <= 100; ++n) ASSERT_EQ(session.step().fault, Fault::none) << name_of(stall.fault) << " " << n;
    const SafetyResult result = session.step();
    EXPECT_EQ(result.fault, stall.fault) << name_of(stall.fault);
    EXPECT_EQ(result.state, State::fault);
    EXPECT_FALSE(session.state.armed);
    // What comes back does not clear it.
    session.*stall.what = true;
    session.step();
    EXPECT_EQ(session.step().fault, stall.fault);
    EXPECT_FALSE(arm(session.state));
    EXPECT_EQ(session.step().force, Vec3(0));
  }
}

TEST(SafetyLayers, ALateTickAloneIsAFault) {
  Session session;
  session.push(Vec3(0, 1, 0));
  session.limits.stall_time = 0.1;
  EXPECT_EQ(session.step(0.0999).fault, Fault::none);
  EXPECT_EQ(session.step(0.1001).fault, Fault::tick_late);
}

/// A limit is the most that is allowed: what is as late, as old or as fast as its limit is no fault, and a hair more
/// is. All times are multiples of powers of two, so that sums and differences are exact.
TEST(SafetyLayers, WhatIsAtItsLimitIsAllowed) {
  constexpr double limit = 0.125, hair = 0x1p-20;
  constexpr Stall stalls[] = {{Fault::tick_late, &SafetyLimits::stall_time, nullptr},
                              {Fault::device_silent, &SafetyLimits::stall_time, &Session::new_pose},
                              {Fault::force_stale, &SafetyLimits::stall_time, &Session::new_force},
                              {Fault::commander_silent, &SafetyLimits::heartbeat_time, &Session::alive}};
  for (const double over : {0.0, hair}) {
    for (const Stall& stall : stalls) {
      Session session;
      arm(session.state);
      session.step(0);
      session.limits.*stall.limit = limit;
      if (stall.what != nullptr) session.*stall.what = false;
      const int ticks = stall.what != nullptr ? 128 : 1;
      for (int n = 1; n < ticks; ++n) EXPECT_EQ(session.step(limit / ticks).fault, Fault::none);
      EXPECT_EQ(session.step(limit / ticks + over).fault, over > 0 ? stall.fault : Fault::none) << name_of(stall.fault);
    }
    Session session;
    arm(session.state);
    session.step(0);
    session.limits.speed = 1;
    session.limits.speed_filter_time = 0x1p-10;  // as long as the tick: half of a step of speed shows
    session.input.reading.position.y = (2 + over) * 0x1p-10;
    EXPECT_EQ(session.step(0x1p-10).fault, over > 0 ? Fault::speed_exceeded : Fault::none);
  }
}

TEST(SafetyLayers, TheSpeedAloneAlongAnyDirection) {
  std::mt19937 random(4);
  for (int n = 0; n < 50; ++n) {
    const Vec3 direction = any_force(random, 1, 1);
    for (const double speed : {0.98, 1.02}) {
      Session session;
      session.push(Vec3(0, 1, 0));
      session.limits.speed = 1;
      SafetyResult result;
      for (int i = 0; i < 30; ++i) {
        session.input.reading.position += direction * (speed * tick);
        result = session.step();
      }
      EXPECT_EQ(result.fault, speed > 1 ? Fault::speed_exceeded : Fault::none) << speed;
      EXPECT_NEAR(result.speed, speed, 1e-3);
    }
  }
}

/// The low pass on the speed is one of first order: a step of speed shows 1 - (T / (T + dt))^n of itself after n ticks.
TEST(SafetyLayers, TheSpeedsLowPassHasItsTime) {
  Session session;
  session.push(Vec3(0));
  session.limits.speed_filter_time = 4e-3;
  for (int n = 1; n <= 20; ++n) {
    session.input.reading.position.x += 0.5 * tick;
    EXPECT_NEAR(session.step().speed, 0.5 * (1 - std::pow(4.0 / 5.0, n)), 1e-9) << n;
  }
}

/// After a fault the force falls in fall_time; where only the commander is silent, in ramp_time, for the hand's sake.
TEST(SafetyLayers, EachFaultFallsInItsTime) {
  for (const bool commander : {true, false}) {
    Session session;
    session.push(Vec3(0, 1, 0));
    session.limits.ramp_time = 0.4;
    session.limits.fall_time = 0.05;
    session.limits.heartbeat_time = 0.01;
    session.limits.stall_time = 0.01;
    (commander ? session.alive : session.new_pose) = false;
    int falling = 0;
    for (int n = 0; n < 1000; ++n) {
      const double force = session.step().force.y;
      falling += force > 0 && force < 1 ? 1 : 0;
    }
    EXPECT_NEAR(falling * tick, commander ? 0.4 : 0.05, 2.5 * tick);
  }
}

/// What is not a number is nothing to slew or ramp from: the force is zero in that tick, however slow both are, and
/// what was felt before does not come back with the next number.
TEST(SafetyLayers, WhatIsNotANumberEndsTheForceAtOnce) {
  for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool of_pose : {true, false}) {
        Session session;
        session.push(Vec3(1, 1, 1));
        session.limits.slew = 1;
        session.limits.fall_time = 100;
        session.limits.ramp_time = 100;
        (of_pose ? session.input.reading.position : session.input.force)[axis] = odd;
        const SafetyResult result = session.step();
        EXPECT_EQ(result.force, Vec3(0));
        EXPECT_EQ(result.gain, 0);
        EXPECT_EQ(result.fault, of_pose ? Fault::pose_not_finite : Fault::force_not_finite);
        session.input.reading.position = Vec3(0);
        session.input.force = Vec3(1, 1, 1);
        EXPECT_EQ(session.step().force, Vec3(0));
        clear_fault(session.state);
        EXPECT_TRUE(arm(session.state));
        session.step();
        EXPECT_LT(glm::length(session.step().force), 1e-4) << "ramped and slewed from zero";
      }
    }
  }
}

/// So does any limit that is no limit. When it is one again the force stays away, and comes back from zero when the
/// fault was cleared and the filter armed.
TEST(SafetyLayers, ALimitThatIsNotANumberOrNegativeEndsTheForceAtOnce) {
  for (double SafetyLimits::*limit :
       {&SafetyLimits::force, &SafetyLimits::device_force, &SafetyLimits::slew, &SafetyLimits::slew_time,
        &SafetyLimits::ramp_time, &SafetyLimits::fall_time, &SafetyLimits::speed, &SafetyLimits::speed_filter_time,
        &SafetyLimits::force_age, &SafetyLimits::pose_age, &SafetyLimits::stall_time, &SafetyLimits::heartbeat_time}) {
    for (const double no_limit : {std::nan(""), -1e-9}) {
      Session session;
      session.push(Vec3(1, 2, 3));
      session.limits.fall_time = 100;
      session.limits.ramp_time = 0.1;
      const SafetyLimits before = session.limits;
      session.limits.*limit = no_limit;
      session.input.force = Vec3(3, 2, 1);
      const SafetyResult result = session.step();
      EXPECT_EQ(result.force, Vec3(0));
      EXPECT_EQ(result.fault, Fault::force_not_finite);
      session.limits = before;
      for (int n = 0; n < 10; ++n) EXPECT_EQ(session.step().force, Vec3(0));
      clear_fault(session.state);
      EXPECT_TRUE(arm(session.state));
      for (int n = 0; n <= 100; ++n) {
        EXPECT_LT(glm::distance(session.step().force, n * tick / 0.1 * session.input.force), 1e-9) << n;
      }
    }
  }
}

/// Where limits limit nothing, forces whose difference is no number end in a fault, from which the force comes back.
TEST(SafetyLayers, WithHugeLimitsAForceIsStillANumber) {
  for (const double huge : {1.7e308, std::numeric_limits<double>::infinity()}) {
    Session session;
    session.push(Vec3(1, 2, 3));
    session.limits.force = session.limits.device_force = session.limits.slew = huge;
    for (const double x : {1.7e308, -1.7e308}) {
      session.input.force = Vec3(x, 0, 0);
      for (int n = 0; n < 10; ++n) EXPECT_TRUE(is_finite(session.step(1).force));
    }
    EXPECT_EQ(session.step(1).force, Vec3(0));
    EXPECT_EQ(session.state.fault, Fault::force_not_finite);
    session.input.force = Vec3(0, 1, 0);
    session.step(1);
    clear_fault(session.state);
    arm(session.state);
    session.limits = SafetyLimits{};
    for (int n = 0; n < 1000; ++n) session.step();
    EXPECT_EQ(session.step().force, Vec3(0, 1, 0));
  }
}

/// What is told is what came first: a fault is not renamed by what it brings with it.
TEST(SafetyLayers, TheFirstCauseIsKept) {
  Session session;
  session.push(Vec3(0, 1, 0));
  session.input.device = State::fault;
  EXPECT_EQ(session.step().fault, Fault::device_lost);
  session.input.reading.position.x = std::nan("");
  EXPECT_EQ(session.step().fault, Fault::device_lost);
  session.input.reading.position.x = 0;
  session.input.force.z = std::nan("");
  EXPECT_EQ(session.step().fault, Fault::device_lost);
  clear_fault(session.state);
  EXPECT_EQ(session.step().fault, Fault::force_not_finite);
}

TEST(SafetyLayers, ADeviceThatCannotPushGetsNothing) {
  for (const State state :
       {State::disconnected, State::idle, State::homing, State::ramping, State::active, State::fault}) {
    Session session;
    session.push(Vec3(0, 1, 0));
    session.input.device = state;
    const SafetyResult result = session.step();
    const bool can = state == State::idle || state == State::ramping || state == State::active;
    EXPECT_EQ(result.force, can ? Vec3(0, 1, 0) : Vec3(0)) << static_cast<int>(state);
    EXPECT_EQ(result.fault, can || state == State::homing ? Fault::none : Fault::device_lost);
  }
}

}  // namespace
}  // namespace palpate::device
