/// Each fault of the safety filter alone, with all layers out of the way, reached to the tick; how the force then
/// falls.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "device/safety/safety_filter.h"
#include "device/testing/filter_session.h"
#include "device/vectors.h"

namespace palpate::device {
namespace {

struct Stall {
  Fault fault;
  double SafetyLimits::*limit;
  bool FilterSession::*what;
};

/// Each stall alone, to the tick.
TEST(SafetyFaults, EachStallAloneIsItsOwnFault) {
  for (const Stall& stall : {Stall{Fault::device_silent, &SafetyLimits::stall_time, &FilterSession::new_pose},
                             Stall{Fault::force_stale, &SafetyLimits::stall_time, &FilterSession::new_force},
                             Stall{Fault::commander_silent, &SafetyLimits::heartbeat_time, &FilterSession::alive}}) {
    FilterSession session;
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

TEST(SafetyFaults, ALateTickAloneIsAFault) {
  FilterSession session;
  session.push(Vec3(0, 1, 0));
  session.limits.stall_time = 0.1;
  EXPECT_EQ(session.step(0.0999).fault, Fault::none);
  EXPECT_EQ(session.step(0.1001).fault, Fault::tick_late);
}

/// A limit is the most that is allowed: what is as late, as old or as fast as its limit is no fault, and a hair more
/// is. All times are multiples of powers of two, so that sums and differences are exact.
TEST(SafetyFaults, WhatIsAtItsLimitIsAllowed) {
  constexpr double limit = 0.125, hair = 0x1p-20;
  constexpr Stall stalls[] = {{Fault::tick_late, &SafetyLimits::stall_time, nullptr},
                              {Fault::device_silent, &SafetyLimits::stall_time, &FilterSession::new_pose},
                              {Fault::force_stale, &SafetyLimits::stall_time, &FilterSession::new_force},
                              {Fault::commander_silent, &SafetyLimits::heartbeat_time, &FilterSession::alive}};
  for (const double over : {0.0, hair}) {
    for (const Stall& stall : stalls) {
      FilterSession session;
      arm(session.state);
      session.step(0);
      session.limits.*stall.limit = limit;
      if (stall.what != nullptr) session.*stall.what = false;
      const int ticks = stall.what != nullptr ? 128 : 1;
      for (int n = 1; n < ticks; ++n) EXPECT_EQ(session.step(limit / ticks).fault, Fault::none);
      EXPECT_EQ(session.step(limit / ticks + over).fault, over > 0 ? stall.fault : Fault::none) << name_of(stall.fault);
    }
    FilterSession session;
    arm(session.state);
    session.step(0);
    session.limits.speed = 1;
    session.limits.speed_filter_time = 0x1p-10;  // as long as the tick: half of a step of speed shows
    session.input.reading.position.y = (2 + over) * 0x1p-10;
    EXPECT_EQ(session.step(0x1p-10).fault, over > 0 ? Fault::speed_exceeded : Fault::none);
  }
}

TEST(SafetyFaults, TheSpeedAloneAlongAnyDirection) {
  std::mt19937 random(4);
  for (int n = 0; n < 50; ++n) {
    const Vec3 direction = any_force(random, 1, 1);
    for (const double speed : {0.98, 1.02}) {
      FilterSession session;
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
TEST(SafetyFaults, TheSpeedsLowPassHasItsTime) {
  FilterSession session;
  session.push(Vec3(0));
  session.limits.speed_filter_time = 4e-3;
  for (int n = 1; n <= 20; ++n) {
    session.input.reading.position.x += 0.5 * tick;
    EXPECT_NEAR(session.step().speed, 0.5 * (1 - std::pow(4.0 / 5.0, n)), 1e-9) << n;
  }
}

/// Whatever the fault: the force falls in fall_time.
TEST(SafetyFaults, EachFaultFallsInItsTime) {
  for (const bool commander : {true, false}) {
    FilterSession session;
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
    EXPECT_NEAR(falling * tick, 0.05, 2.5 * tick);
  }
}

/// What is not a number is nothing to slew or ramp from: the force is zero in that tick, however slow both are, and
/// what was felt before does not come back with the next number.
TEST(SafetyFaults, WhatIsNotANumberEndsTheForceAtOnce) {
  for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool of_pose : {true, false}) {
        FilterSession session;
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
TEST(SafetyFaults, ALimitThatIsNotANumberOrNegativeEndsTheForceAtOnce) {
  for (double SafetyLimits::*limit :
       {&SafetyLimits::force, &SafetyLimits::device_force, &SafetyLimits::slew, &SafetyLimits::slew_time,
        &SafetyLimits::ramp_time, &SafetyLimits::fall_time, &SafetyLimits::speed, &SafetyLimits::speed_filter_time,
        &SafetyLimits::force_age, &SafetyLimits::pose_age, &SafetyLimits::stall_time, &SafetyLimits::heartbeat_time}) {
    for (const double no_limit : {std::nan(""), -1e-9}) {
      FilterSession session;
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
TEST(SafetyFaults, WithHugeLimitsAForceIsStillANumber) {
  for (const double huge : {1.7e308, std::numeric_limits<double>::infinity()}) {
    FilterSession session;
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
TEST(SafetyFaults, TheFirstCauseIsKept) {
  FilterSession session;
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

TEST(SafetyFaults, ADeviceThatCannotPushGetsNothing) {
  for (const State state :
       {State::disconnected, State::idle, State::homing, State::ramping, State::active, State::fault}) {
    FilterSession session;
    session.push(Vec3(0, 1, 0));
    session.input.device = state;
    const SafetyResult result = session.step();
    const bool can = state == State::idle || state == State::ramping || state == State::active;
    EXPECT_EQ(result.force, can ? Vec3(0, 1, 0) : Vec3(0)) << static_cast<int>(state);
    EXPECT_EQ(result.fault, can || state == State::homing ? Fault::none : Fault::device_lost);
  }
}

/// A hand that goes on into a wall of 400 N/m after the fault was pushed with 2.8 N where it had felt 0.1 N.
TEST(SafetyFaults, AfterAFaultTheForceNeverGrowsWhereverTheHandGoes) {
  enum Cause { released, too_fast, dead_panel, lost_device, old_force };
  for (const Cause cause : {released, too_fast, dead_panel, lost_device, old_force}) {
    for (unsigned seed = 0; seed < 400; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> chance(0, 1);
      FilterSession session;
      session.limits = {.force = std::uniform_real_distribution<double>(0.5, 12)(random)};
      const double stiffness = std::exp(std::uniform_real_distribution<double>(std::log(50), std::log(1e5))(random));
      const Vec3 wall = any_force(random, 1, 1);
      const Vec3 velocity = any_force(random, 0.01, 0.9);  // m/s
      Vec3 hand = -wall * chance(random) * 1e-3;           // m: up to 1 mm into the wall
      session.step();
      arm(session.state);
      const int before = 3 + static_cast<int>(700 * chance(random));
      session.input.force = -stiffness * hand;
      double most = 0;
      for (int ms = 0; ms < before; ++ms) most = glm::length(session.step().force);
      switch (cause) {
        case released:
          disarm(session.state);
          break;
        case too_fast:
          session.input.reading.position += Vec3(0.1, 0, 0);
          break;
        case dead_panel:
          session.alive = false;
          session.input.heartbeat_time = session.input.time - 2.001;
          break;
        case lost_device:
          session.input.device = State::fault;
          break;
        case old_force:
          session.new_force = false;
          session.input.force_time = session.input.time - 0.11;
          break;
      }
      for (int ms = 1; ms < 100; ++ms) {
        hand += velocity * tick;
        session.input.force = -stiffness * hand;
        const double length = glm::length(session.step().force);
        ASSERT_LE(length, most * (1 + 1e-12)) << "seed " << seed << ", cause " << cause << ", " << ms << " ms";
        most = length;
        if (ms * tick > session.limits.fall_time + tick) {
          ASSERT_EQ(length, 0) << "seed " << seed << ", cause " << cause;
        }
      }
      EXPECT_EQ(session.state.fault == Fault::none, cause == released);
    }
  }
}

}  // namespace
}  // namespace palpate::device
