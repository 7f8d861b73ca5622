/// The whole chain with the limits that a session has.

#include "device/safety/safety_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

#include "device/testing/filter_session.h"

namespace palpate::device {
namespace {

/// What happened while nothing was pushed does not matter: neither what became of the device, nor a pause, nor where
/// the hand is after it.
TEST(SafetyFilter, GivesNoForceUntilArmed) {
  FilterSession session = FilterSession::with_defaults(Vec3(0, 1, 0));
  for (const State device : {State::idle, State::disconnected, State::fault, State::idle}) {
    session.input.device = device;
    for (int n = 0; n < 500; ++n) {
      session.input.reading.position.x += 2e-3;
      const SafetyResult result = session.step();
      ASSERT_EQ(result.force, Vec3(0));
      ASSERT_EQ(result.state, device);
      ASSERT_EQ(result.fault, Fault::none);
    }
  }
  session.input.time += 100;
  session.input.reading.position = Vec3(0.05, 0, 0);
  arm(session.state);
  EXPECT_EQ(session.run(0.6).force, Vec3(0, 1, 0)) << name_of(session.state.fault);
}

/// Also no force: one that is asked for is not taken away, and so does not come back along the ramp.
TEST(SafetyFilter, PassesWhatIsWithinTheLimitsUnchanged) {
  std::mt19937 random(1);
  FilterSession session = FilterSession::with_defaults(Vec3(0));
  arm(session.state);
  session.run(0.6);
  for (int i = 0; i < 1000; ++i) {
    session.input.force = i % 10 < 2 ? Vec3(0) : any_force(random, 0, 0.5);  // N: a tick slews by 1
    const SafetyResult result = session.step();
    ASSERT_EQ(result.force, session.input.force) << i;
    ASSERT_FALSE(result.clamped || result.slewed);
    ASSERT_EQ(result.state, State::active);
  }
}

/// Encoders jump at the index pulse, and neither where the hand was nor how fast it was means anything after.
TEST(SafetyFilter, HomingIsWithoutForceAndForgetsWhatWasBefore) {
  FilterSession session = FilterSession::with_defaults(Vec3(0, 1, 0));
  arm(session.state);
  session.run(0.6);
  for (int i = 0; i < 50; ++i) {
    session.input.reading.position.x += 0.9 * tick;
    session.step();
  }
  session.input.device = State::homing;
  for (const double x : {0.0, 0.1, -0.1}) {
    session.input.reading.position.x = x;
    const SafetyResult result = session.step();
    EXPECT_EQ(result.force, Vec3(0));
    EXPECT_EQ(result.speed, 0);
    EXPECT_EQ(result.state, State::homing);
  }
  session.input.device = State::idle;
  session.input.reading.position.x = 0.2;
  const SafetyResult result = session.step();
  EXPECT_LT(glm::length(result.force), 0.01) << "ramped from the start";
  EXPECT_EQ(result.speed, 0);
  EXPECT_EQ(session.run(0.6).force, Vec3(0, 1, 0)) << name_of(session.state.fault);
}

bool same(const SafetyResult& a, const SafetyResult& b) {
  const bool same_speed = a.speed == b.speed || (std::isnan(a.speed) && std::isnan(b.speed));  // of poses of 1e308 m
  return same_speed && std::tie(a.force, a.state, a.fault, a.gain, a.clamped, a.slewed) ==
                           std::tie(b.force, b.state, b.fault, b.gain, b.clamped, b.slewed);
}

/// The law that matters most, against anything: whatever comes in, what goes out is a number, within the force limit
/// and changes no faster than slew and ramps allow, except to fall to zero. And it follows from what goes in alone.
TEST(SafetyFilter, HoldsItsLimitsAgainstAnything) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const double odd_numbers[] = {nan, infinity, -infinity, 1e308, -1e308, 5e-324, 0.0, -0.0};
  const State states[] = {State::disconnected, State::idle, State::homing, State::ramping, State::active, State::fault};
  SafetyLimits limits;
  SafetyState state;
  SafetyInput input;
  Vec3 before(0);
  int with_force = 0;
  for (int i = 0; i < 400'000; ++i) {
    const bool wild = random() % 500 == 0;
    const double elapsed = wild ? 0.05 * std::abs(normal(random)) : tick;
    input.time += elapsed;
    input.reading.fresh = random() % 4 != 0;
    for (int axis = 0; axis < 3; ++axis) {
      input.force[axis] += normal(random);
      input.force[axis] *= 0.99;
      input.reading.position[axis] = 1e-4 * normal(random);
    }
    if (random() % 2000 == 0) input.force[static_cast<int>(random() % 3)] = odd_numbers[random() % 8];
    if (!std::isfinite(input.force.x + input.force.y + input.force.z)) input.force = Vec3(nan, 0, 0);
    if (random() % 3000 == 0) input.reading.position.y = odd_numbers[random() % 8];
    input.device = random() % 3000 == 0 ? states[random() % 6] : State::idle;
    input.force_time = input.time - (wild ? 0.02 * std::abs(normal(random)) : 0);
    input.heartbeat_time = input.time - (random() % 20000 == 0 ? 3 : 0);
    if (random() % 300 == 0) clear_fault(state);
    if (random() % 200 == 0) arm(state);

    SafetyState copy = state;
    const SafetyResult result = filter_force(limits, input, state);
    ASSERT_TRUE(same(filter_force(limits, input, copy), result));
    if (std::isnan(input.force.x)) input.force = Vec3(0);
    const double length = glm::length(result.force);
    ASSERT_TRUE(std::isfinite(length)) << i;
    ASSERT_LE(length, limits.force) << i;
    const double usable = std::min(elapsed, limits.force_age);
    const double slewed = limits.slew * std::min(elapsed, limits.slew_time);
    const double most = slewed + limits.force / limits.fall_time * usable + 1e-9;
    ASSERT_TRUE(result.force == Vec3(0) || glm::length(result.force - before) <= most) << i;
    if (!state.armed && result.gain == 0) {
      ASSERT_EQ(result.force, Vec3(0));
    }
    before = result.force;
    with_force += length > 0.1 ? 1 : 0;
  }
  EXPECT_GT(with_force, 20'000) << "the test has to have pushed for a good part of the time";
}

/// Summaries, last-fault.csv and `palpate devices` name a fault by these words.
TEST(SafetyFilter, EveryFaultHasItsOwnNameAndSaysWhatToDo) {
  const std::pair<Fault, const char*> names[] = {{Fault::none, "none"},
                                                 {Fault::pose_not_finite, "pose not finite"},
                                                 {Fault::force_not_finite, "force not finite"},
                                                 {Fault::device_lost, "device lost"},
                                                 {Fault::device_silent, "device silent"},
                                                 {Fault::force_stale, "force stale"},
                                                 {Fault::tick_late, "tick late"},
                                                 {Fault::speed_exceeded, "speed exceeded"},
                                                 {Fault::commander_silent, "commander silent"}};
  for (const auto& [fault, name] : names) {
    EXPECT_STREQ(name_of(fault), name);
    EXPECT_EQ(advice_for(fault).empty(), fault == Fault::none);
  }
}

}  // namespace
}  // namespace palpate::device
