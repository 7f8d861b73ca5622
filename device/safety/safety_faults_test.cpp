/// Each fault of the safety filter alone, with all layers out of the way, reached to the tick; how the force then
/// falls.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <utility>

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
    for (const bool of_pose : {true, false}) {  // and what is as old as it may be still counts
      FilterSession session;
      session.input.force = Vec3(0, 1, 0);
      arm(session.state);
      session.step(0);
      (of_pose ? session.limits.pose_age : session.limits.force_age) = limit;
      (of_pose ? session.new_pose : session.new_force) = false;
      for (int n = 1; n < 128; ++n) EXPECT_EQ(session.step(limit / 128).force, Vec3(0, 1, 0)) << n;
      EXPECT_EQ(session.step(limit / 128 + over).force, over > 0 ? Vec3(0) : Vec3(0, 1, 0));
    }
    FilterSession session;
    arm(session.state);
    session.step(0);
    session.limits.speed = 1;
    session.limits.speed_smoothing_time = 0x1p-10;  // as long as the tick: half of a step of speed shows
    session.input.reading.position.y = (2 + over) * 0x1p-10;
    EXPECT_EQ(session.step(0x1p-10).fault, over > 0 ? Fault::speed_exceeded : Fault::none);
  }
}

/// The low pass on the speed is one of first order: of a speed v along any direction, v (1 - (T / (T + dt))^n) shows
/// after n poses that are dt apart, however many ticks that is, and that is what the limit is for. A pose of the same
/// instant as the one before tells no speed.
TEST(SafetyFaults, TheSpeedAloneAlongAnyDirection) {
  std::mt19937 random(4);
  for (int n = 0; n < 60; ++n) {
    const Vec3 direction = any_force(random, 1, 1);
    const int ticks = 1 + n % 3;  // from pose to pose
    const double left = 4.0 / (4 + ticks);
    for (const double speed : {0.5, 0.98, 1.02, 4.0}) {
      FilterSession session;
      session.push(Vec3(0, 1, 0));
      session.limits.speed = 1;
      session.limits.speed_smoothing_time = 4e-3;
      double shown = 0;
      for (int i = 1; i <= 30 && shown <= 1; ++i) {
        session.new_pose = false;
        for (int t = 1; t < ticks; ++t) EXPECT_NEAR(session.step().speed, shown, 1e-9);
        session.new_pose = true;
        session.input.reading.position += direction * (speed * ticks * tick);
        shown = speed * (1 - std::pow(left, i));
        const SafetyResult result = session.step();
        EXPECT_NEAR(result.speed, shown, 1e-9);
        ASSERT_EQ(result.fault, shown > 1 ? Fault::speed_exceeded : Fault::none) << speed << " " << i;
        session.input.reading.position += direction;
        EXPECT_NEAR(session.step(0).speed, shown, 1e-9);
        session.input.reading.position -= direction;
      }
    }
  }
}

/// What is not a number, or a limit that is negative, ends the force in that tick, however slow slew and fall are. When
/// all is a number again the force stays away, and comes back along the ramp, from zero, once the fault was cleared and
/// the filter armed.
TEST(SafetyFaults, WhatIsNoNumberOrNoLimitEndsTheForceAtOnce) {
  const auto ends_the_force = [](Fault fault, auto&& spoil) {
    FilterSession session;
    session.push(Vec3(1, 2, 3));
    session.limits.slew = 1;
    session.limits.fall_time = 100;
    session.limits.ramp_time = 0.1;
    const FilterSession before = session;
    spoil(session);
    const SafetyResult result = session.step();
    EXPECT_EQ(result.force, Vec3(0));
    EXPECT_EQ(result.gain, 0);
    EXPECT_EQ(result.fault, fault);
    EXPECT_EQ(result.state, State::fault);
    session.limits = before.limits;
    session.limits.slew = 1e12;
    session.input.reading.position = before.input.reading.position;
    session.input.force = Vec3(3, 2, 1);
    EXPECT_EQ(session.run(1).force, Vec3(0));
    clear_fault(session.state);
    EXPECT_TRUE(arm(session.state));
    for (int n = 0; n <= 100; ++n) {
      EXPECT_LT(glm::distance(session.step().force, n * tick / 0.1 * session.input.force), 1e-9) << n;
    }
  };
  for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (int axis = 0; axis < 3; ++axis) {
      ends_the_force(Fault::pose_not_finite, [&](FilterSession& of) { of.input.reading.position[axis] = odd; });
      ends_the_force(Fault::force_not_finite, [&](FilterSession& of) { of.input.force[axis] = odd; });
    }
  }
  for (double SafetyLimits::*limit :
       {&SafetyLimits::force, &SafetyLimits::device_force, &SafetyLimits::slew, &SafetyLimits::slew_time,
        &SafetyLimits::ramp_time, &SafetyLimits::fall_time, &SafetyLimits::speed, &SafetyLimits::speed_smoothing_time,
        &SafetyLimits::force_age, &SafetyLimits::pose_age, &SafetyLimits::stall_time, &SafetyLimits::heartbeat_time}) {
    for (const double no_limit : {std::nan(""), -1e-9}) {
      ends_the_force(Fault::force_not_finite, [&](FilterSession& of) { of.limits.*limit = no_limit; });
    }
    FilterSession session;
    session.push(Vec3(1, 2, 3));
    session.limits.*limit = 0;
    EXPECT_NE(session.step().fault, Fault::force_not_finite) << "zero is a limit like others";
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
      for (int n = 0; n < 10; ++n) {
        const SafetyResult result = session.step(1);
        EXPECT_TRUE(is_finite(result.force));
        EXPECT_EQ(result.fault, session.state.fault) << "told in its own tick";
        if (result.fault != Fault::none) {
          EXPECT_EQ(result.force, Vec3(0));
        }
      }
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

/// Whatever the cause: a hand that goes on into a wall is pushed by less from tick to tick, by no step that slew and
/// fall do not allow, and by nothing after the time of the fall. So it stays though all is well again, until the fault
/// is cleared and the filter armed; then it comes back along the ramp.
TEST(SafetyFaults, AfterAFaultTheForceFallsWhereverTheHandGoesAndStaysAway) {
  enum Cause { released, too_fast, dead_panel, lost_device, old_force, old_pose, late_tick };
  for (const Cause cause : {released, too_fast, dead_panel, lost_device, old_force, old_pose, late_tick}) {
    constexpr Fault faults[] = {Fault::none,        Fault::speed_exceeded, Fault::commander_silent, Fault::device_lost,
                                Fault::force_stale, Fault::device_silent,  Fault::tick_late};
    for (unsigned seed = 0; seed < 200; ++seed) {
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
      session.input.force = -stiffness * hand;
      double most = glm::length(session.run(0.003 + 0.7 * chance(random)).force);
      double late = tick;
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
        case old_pose:
          session.new_pose = false;
          session.state.pose_time = session.input.time - 0.11;
          break;
        case late_tick:
          late = 0.11;
          break;
      }
      for (int ms = 1; ms < 100; ++ms) {
        hand += velocity * tick;
        session.input.force = -stiffness * hand;
        const double elapsed = std::exchange(late, tick);
        const double length = glm::length(session.step(elapsed).force);
        const SafetyLimits& limits = session.limits;
        const double step = limits.slew * std::min(elapsed, limits.slew_time) +
                            limits.force / limits.fall_time * std::min(elapsed, limits.force_age);
        ASSERT_LE(length, most * (1 + 1e-12)) << "seed " << seed << ", cause " << cause << ", " << ms << " ms";
        ASSERT_LE(cause == lost_device ? 0 : most - length, step + 1e-12) << "seed " << seed << ", cause " << cause;
        most = length;
        if (ms * tick > limits.fall_time + tick) {
          ASSERT_EQ(length, 0) << "seed " << seed << ", cause " << cause;
        }
      }
      ASSERT_EQ(session.state.fault, faults[cause]) << name_of(session.state.fault);
      if (seed >= 20) continue;  // what follows is the same for each
      session.new_force = session.new_pose = session.alive = true;
      session.input.device = State::idle;
      session.input.force = any_force(random, 0.1, 0.5);
      EXPECT_EQ(session.run(0.1).force, Vec3(0));
      EXPECT_EQ(arm(session.state), cause == released);
      clear_fault(session.state);
      EXPECT_EQ(session.run(0.1).force, Vec3(0)) << "cleared, not armed";
      EXPECT_TRUE(arm(session.state));
      EXPECT_LT(glm::length(session.step().force), 0.01) << "ramped once more";
      EXPECT_EQ(session.run(0.6).force, session.input.force);
    }
  }
}

}  // namespace
}  // namespace palpate::device
