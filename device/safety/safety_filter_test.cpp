#include "device/safety/safety_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <string>
#include <utility>

namespace palpate::device {
namespace {

constexpr double filter_tick = 1e-3;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A healthy session at 1 kHz: each step() is one tick with everything fresh, unless a field of `input` was frozen.
struct Session {
  SafetyLimits limits;
  SafetyState state;
  SafetyInput input;
  SafetyResult result;
  bool new_pose = true;
  bool new_force = true;
  bool commander_alive = true;

  explicit Session(const Vec3& force = Vec3(0, 1, 0)) { input.force = force; }

  const SafetyResult& step(double elapsed = filter_tick) {
    input.time += elapsed;
    input.reading.time = input.time;
    input.reading.fresh = new_pose;
    if (new_force) input.force_time = input.time;
    if (commander_alive) input.heartbeat_time = input.time;
    return result = filter_force(limits, input, state);
  }
  const SafetyResult& run(double seconds) {
    for (int i = 0; i < std::lround(seconds / filter_tick); ++i) step();
    return result;
  }
  void activate() {
    step();
    arm(state);
    run(0.6);
    ASSERT_EQ(result.state, State::active);
  }
};

TEST(SafetyFilter, GivesNoForceUntilArmed) {
  Session session;
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(session.step().force, Vec3(0));
  EXPECT_EQ(session.result.state, State::idle);
}

TEST(SafetyFilter, RampsUpEvenlyOverTheRampTime) {
  Session session;
  session.step();
  arm(session.state);
  session.step();
  double previous = 0;
  for (int i = 1; i < 500; ++i) {
    const SafetyResult& result = session.step();
    EXPECT_NEAR(result.force.y, i / 500.0, 1e-9);
    EXPECT_GE(result.force.y, previous);
    EXPECT_EQ(result.state, State::ramping);
    previous = result.force.y;
  }
  session.run(0.01);
  EXPECT_EQ(session.result.force, Vec3(0, 1, 0));
  EXPECT_EQ(session.result.state, State::active);
}

TEST(SafetyFilter, ClampsTheLengthAndKeepsTheDirection) {
  Session session(Vec3(30, -40, 0));
  session.activate();
  EXPECT_TRUE(session.result.clamped);
  EXPECT_NEAR(glm::length(session.result.force), 3, 1e-12);
  EXPECT_LE(glm::length(session.result.force), 3);
  EXPECT_NEAR(session.result.force.x / session.result.force.y, -0.75, 1e-12);
}

TEST(SafetyFilter, ClampsAForceWhoseSquareOverflows) {
  Session session(Vec3(1e300, 1e300, 0));
  session.activate();
  EXPECT_NEAR(session.result.force.x, 3 / std::sqrt(2), 1e-12);
}

TEST(SafetyFilter, HoldsTheDevicesOwnLimitLast) {
  Session session(Vec3(0, 2, 0));
  session.limits.device_force = 0.5;
  session.activate();
  EXPECT_NEAR(session.result.force.y, 0.5, 1e-12);
}

TEST(SafetyFilter, LimitsTheSlew) {
  Session session(Vec3(0));
  session.activate();
  session.input.force = Vec3(3, 0, 0);
  EXPECT_NEAR(session.step().force.x, 1, 1e-9);
  EXPECT_TRUE(session.result.slewed);
  EXPECT_NEAR(session.step().force.x, 2, 1e-9);
  EXPECT_NEAR(session.step().force.x, 3, 1e-9);
  session.input.force = Vec3(-3, 0, 0);
  EXPECT_NEAR(session.step().force.x, 2, 1e-9);
}

TEST(SafetyFilter, PassesWhatIsWithinTheLimitsUnchanged) {
  Session session;
  session.activate();
  for (int i = 0; i < 1000; ++i) {
    session.input.force = Vec3(std::sin(0.01 * i), 1 + 0.3 * std::cos(0.02 * i), -0.5);
    session.step();
    if (i > 2) {
      ASSERT_EQ(session.result.force, session.input.force) << i;
    }
  }
}

TEST(SafetyFilter, TakesTheForceAwayAtOnceWhereANumberIsMissing) {
  for (const double bad : {nan, infinity, -infinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Session of_force;
      of_force.activate();
      of_force.input.force[axis] = bad;
      EXPECT_EQ(of_force.step().force, Vec3(0));
      EXPECT_EQ(of_force.result.fault, Fault::force_not_finite);
      of_force.input.force = Vec3(0, 1, 0);
      EXPECT_EQ(of_force.run(1).force, Vec3(0)) << "latched";

      Session of_pose;
      of_pose.activate();
      of_pose.input.reading.position[axis] = bad;
      EXPECT_EQ(of_pose.step().force, Vec3(0));
      EXPECT_EQ(of_pose.result.fault, Fault::pose_not_finite);
      EXPECT_EQ(of_pose.result.state, State::fault);
    }
  }
}

/// After a fault: no jump beyond the limits, zero within the time said, zero for good.
void expect_smooth_fall(Session& session, Fault fault, double within) {
  double previous = glm::length(session.result.force);
  const double slew = session.limits.slew + session.limits.force / session.limits.fall_time;
  for (int i = 0; i < std::lround(within / filter_tick); ++i) {
    session.step();
    const double now = glm::length(session.result.force);
    ASSERT_LE(now, previous + 1e-12);
    ASSERT_LE(previous - now, slew * filter_tick + 1e-12);
    previous = now;
  }
  EXPECT_EQ(session.result.force, Vec3(0));
  EXPECT_EQ(session.result.fault, fault) << name_of(session.result.fault);
  EXPECT_EQ(session.result.state, State::fault);
  session.new_pose = session.new_force = session.commander_alive = true;
  session.input.device = State::idle;
  EXPECT_EQ(session.run(1).force, Vec3(0)) << "latched";
  EXPECT_FALSE(arm(session.state));
  clear_fault(session.state);
  EXPECT_EQ(session.run(1).force, Vec3(0)) << "cleared, not armed";
  EXPECT_TRUE(arm(session.state));
  EXPECT_EQ(session.step().force, Vec3(0)) << "ramped once more";
  EXPECT_EQ(session.run(0.6).force, session.input.force);
}

TEST(SafetyFilter, FallsWhenTheForceGoesStale) {
  Session session;
  session.activate();
  session.new_force = false;
  session.run(0.009);
  EXPECT_EQ(session.result.force, Vec3(0, 1, 0)) << "a few late forces are no fault";
  expect_smooth_fall(session, Fault::force_stale, 0.15);
}

TEST(SafetyFilter, AShortStallOfTheSceneIsForgiven) {
  Session session;
  session.activate();
  session.new_force = false;
  session.run(0.05);
  EXPECT_EQ(session.result.force, Vec3(0));
  EXPECT_EQ(session.result.fault, Fault::none);
  session.new_force = true;
  session.run(0.01);
  EXPECT_LT(session.result.force.y, 0.03) << "it comes back along the ramp";
  session.run(0.5);
  EXPECT_EQ(session.result.force, Vec3(0, 1, 0));
}

TEST(SafetyFilter, FallsWhenTheDeviceGoesSilent) {
  Session session;
  session.activate();
  session.new_pose = false;
  expect_smooth_fall(session, Fault::device_silent, 0.15);
}

TEST(SafetyFilter, FallsWhenTheCommanderGoesSilent) {
  Session session;
  session.activate();
  session.commander_alive = false;
  session.run(1.99);
  EXPECT_EQ(session.result.force, Vec3(0, 1, 0));
  expect_smooth_fall(session, Fault::commander_silent, 0.07);
}

TEST(SafetyFilter, FallsWhenTheHandIsTooFast) {
  Session session;
  session.activate();
  double speed = 0;
  while (session.result.fault == Fault::none && speed < 2) {
    speed += 0.01;
    for (int i = 0; i < 20; ++i) {
      session.input.reading.position.x += speed * filter_tick;
      session.step();
    }
  }
  EXPECT_NEAR(speed, 1, 0.021);
  expect_smooth_fall(session, Fault::speed_exceeded, 0.06);
}

TEST(SafetyFilter, DoesNotMistakePositionStepsForSpeed) {
  Session session;
  session.activate();
  std::mt19937 random(3);
  for (int i = 0; i < 5000; ++i) {
    session.input.reading.position.x = (random() % 2 != 0) ? 0.064e-3 : 0;  // the coarsest device's step
    session.step();
    ASSERT_LT(session.result.speed, 0.1);
  }
}

TEST(SafetyFilter, ALostDeviceIsAFaultOnlyWhileArmed) {
  Session session;
  session.activate();
  session.input.device = State::fault;
  session.step();
  EXPECT_EQ(session.result.force, Vec3(0)) << "nothing can be written";
  expect_smooth_fall(session, Fault::device_lost, 0.06);

  Session unarmed;
  unarmed.input.device = State::disconnected;
  unarmed.run(1);
  EXPECT_EQ(unarmed.result.fault, Fault::none);
  EXPECT_EQ(unarmed.result.state, State::disconnected);
}

TEST(SafetyFilter, GivesExactlyNothingWhileHoming) {
  Session session;
  session.activate();
  session.input.device = State::homing;
  EXPECT_EQ(session.step().force, Vec3(0));
  session.input.reading.position = Vec3(0.1, 0, 0);  // the encoders jump at the index pulse
  session.step();
  session.input.device = State::idle;
  EXPECT_LT(glm::length(session.step().force), 0.01) << "ramped from the start";
  EXPECT_EQ(session.result.fault, Fault::none) << name_of(session.result.fault);
  EXPECT_EQ(session.run(0.6).force, Vec3(0, 1, 0));
}

/// How fast the hand was before is nothing that a device knows once it is homed.
TEST(SafetyFilter, TheSpeedOfBeforeHomingIsForgotten) {
  Session session;
  session.activate();
  for (int i = 0; i < 50; ++i) {
    session.input.reading.position.x += 0.9 * filter_tick;
    session.step();
  }
  ASSERT_NEAR(session.result.speed, 0.9, 0.01);
  session.input.device = State::homing;
  EXPECT_EQ(session.step().speed, 0);
  session.input.device = State::idle;
  EXPECT_EQ(session.step().speed, 0);
}

/// Of a single step of the pose, a third shows as speed: 1 / (1 + 2) for a tick of 1 ms and a low pass of 2 ms.
TEST(SafetyFilter, AStepOfThePoseIsNoFault) {
  Session session;
  session.activate();
  session.input.reading.position.x += 2.4e-3;
  EXPECT_NEAR(session.step().speed, 0.8, 1e-9);
  EXPECT_EQ(session.result.fault, Fault::none);
}

TEST(SafetyFilter, ALateTickIsAFaultAndNeverAStep) {
  Session session(Vec3(0));
  session.activate();
  session.input.force = Vec3(3, 0, 0);
  session.step(0.09);
  EXPECT_EQ(session.result.fault, Fault::none);
  EXPECT_LE(glm::length(session.result.force), session.limits.slew * session.limits.slew_time);
  session.step(0.11);
  EXPECT_EQ(session.result.fault, Fault::tick_late);
}

TEST(SafetyFilter, ArmingAfterAPauseIsNotALateTick) {
  Session session;
  session.step();
  session.input.time += 100;
  session.input.reading.position = Vec3(0.05, 0, 0);
  arm(session.state);
  EXPECT_EQ(session.run(0.6).force, Vec3(0, 1, 0)) << name_of(session.result.fault);
}

TEST(SafetyFilter, DisarmingLetsTheForceFall) {
  Session session;
  session.activate();
  disarm(session.state);
  EXPECT_GT(session.step().force.y, 0.9);
  EXPECT_EQ(session.run(0.06).force, Vec3(0));
  EXPECT_EQ(session.result.state, State::idle);
}

/// The law that matters most, against anything: whatever comes in, what goes out is a number, within the force limit
/// and changes no faster than slew and ramps allow, except to fall to zero.
TEST(SafetyFilter, HoldsItsLimitsAgainstAnything) {
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
    const double elapsed = wild ? 0.05 * std::abs(normal(random)) : filter_tick;
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

    const SafetyResult result = filter_force(limits, input, state);
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

TEST(SafetyFilter, IsAPureFunction) {
  Session session;
  session.activate();
  SafetyState one = session.state;
  SafetyState other = session.state;
  session.input.time += filter_tick;
  const SafetyResult a = filter_force(session.limits, session.input, one);
  const SafetyResult b = filter_force(session.limits, session.input, other);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(one.gain, other.gain);
  EXPECT_EQ(one.slewed_force, other.slewed_force);
}

/// Summaries, last-fault.csv and `palpate devices` name a fault by these words.
TEST(SafetyFilter, EveryFaultHasItsOwnName) {
  const std::pair<Fault, const char*> names[] = {{Fault::none, "none"},
                                                 {Fault::pose_not_finite, "pose not finite"},
                                                 {Fault::force_not_finite, "force not finite"},
                                                 {Fault::device_lost, "device lost"},
                                                 {Fault::device_silent, "device silent"},
                                                 {Fault::force_stale, "force stale"},
                                                 {Fault::tick_late, "tick late"},
                                                 {Fault::speed_exceeded, "speed exceeded"},
                                                 {Fault::commander_silent, "commander silent"}};
  for (const auto& [fault, name] : names) EXPECT_STREQ(name_of(fault), name);
}

TEST(SafetyFilter, TellsWhatToDoAboutEveryFault) {
  for (int i = 0; i <= static_cast<int>(Fault::commander_silent); ++i) {
    const auto fault = static_cast<Fault>(i);
    EXPECT_STRNE(name_of(fault), "unknown");
    EXPECT_EQ(advice_for(fault).empty(), fault == Fault::none);
  }
}

}  // namespace
}  // namespace palpate::device
