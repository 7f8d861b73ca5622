/// The limits of what a simulated stylus may be, each reached; and what it is before and after a session.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "device/device_type.h"
#include "device/simulated/simulated_stylus.h"

namespace palpate::device {
namespace {

bool is_taken(const std::function<void(SimulatedDevice&)>& change) {
  SimulatedDevice device;
  change(device);
  try {
    const SimulatedStylus stylus(device);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

SimulatedDevice steady() {
  SimulatedDevice device;
  device.hand.tremor_rms = 0;
  device.position_step = 0;
  return device;
}

/// Zero where a device may be without, and no less; above zero where it may not.
TEST(SimulatedLimits, EachNumberHasItsLeast) {
  using Number = std::function<double&(SimulatedDevice&)>;
  const struct {
    Number number;
    bool may_be_zero;
  } numbers[] = {{[](SimulatedDevice& d) -> double& { return d.arm.mass; }, false},
                 {[](SimulatedDevice& d) -> double& { return d.hand.mass; }, true},
                 {[](SimulatedDevice& d) -> double& { return d.arm.coulomb_friction; }, true},
                 {[](SimulatedDevice& d) -> double& { return d.arm.viscous_friction; }, true},
                 {[](SimulatedDevice& d) -> double& { return d.hand.stiffness; }, true},
                 {[](SimulatedDevice& d) -> double& { return d.hand.damping; }, true},
                 {[](SimulatedDevice& d) -> double& { return d.position_step; }, true},
                 {[](SimulatedDevice& d) -> double& { return d.delay; }, true},
                 {[](SimulatedDevice& d) -> double& { return d.maximum_force; }, false},
                 {[](SimulatedDevice& d) -> double& { return d.target_speed; }, false}};
  for (const auto& one : numbers) {
    const auto with = [&](double value) { return is_taken([&](SimulatedDevice& d) { one.number(d) = value; }); };
    EXPECT_TRUE(with(1e-9));
    EXPECT_EQ(with(0), one.may_be_zero);
    EXPECT_FALSE(with(-1e-9));
    EXPECT_FALSE(with(std::numeric_limits<double>::quiet_NaN()));
  }
}

/// 100 to 20000 Hz, and a force that is on its way for at most 60 ticks.
TEST(SimulatedLimits, RateAndDelayHaveTheirMost) {
  for (const auto& [rate, taken] : {std::pair{99.9, false}, {100.0, true}, {20000.0, true}, {20000.1, false}}) {
    EXPECT_EQ(is_taken([value = rate](SimulatedDevice& d) { d.rate = value; }), taken) << rate;
  }
  for (const double rate : {500.0, 1000.0, 8000.0}) {
    for (const auto& [ticks, taken] : {std::pair{60.0, true}, {60.1, false}}) {
      EXPECT_EQ(is_taken([rate, delay = ticks / rate](SimulatedDevice& d) {
                  d.rate = rate;
                  d.delay = delay;
                }),
                taken)
          << ticks;
    }
  }
}

/// A free mass tells by its speed since when a force has acted: F (t - delay) / m, at any rate, however long the delay.
TEST(SimulatedLimits, AForceActsAfterItsDelay) {
  for (const double rate : {500.0, 1000.0, 5000.0}) {
    for (const double ticks : {0.0, 0.5, 1.0, 7.25, 59.0, 60.0}) {
      SimulatedDevice device = steady();
      device.hand.stiffness = device.hand.damping = device.hand.mass = 0;
      device.arm.coulomb_friction = device.arm.viscous_friction = 0;
      device.arm.half_extent = Vec3(10);
      device.rate = rate;
      device.delay = ticks / rate;
      SimulatedStylus stylus(device);
      stylus.open();
      for (int n = 1; n <= 130; ++n) {
        const double force = n <= 64 ? 0.5 : -0.25;
        stylus.write_force(Vec3(0, force, 0));
        const double up = std::clamp(n / rate - device.delay, 0.0, 64 / rate);
        const double down = std::max(0.0, (n - 64) / rate - device.delay);
        const double sub_step = 50e-6;  // s
        ASSERT_NEAR(stylus.body().velocity.y, (0.5 * up - 0.25 * down) / device.arm.mass,
                    0.51 * 0.75 * sub_step / device.arm.mass)
            << rate << " Hz, " << ticks << " ticks, tick " << n;
      }
    }
  }
}

/// One step of the body against its equation: (m_d + m_h) a = F - b v - c v / |v| + k (target - x) + d (target' - v),
/// at the end of the step, along any direction.
TEST(SimulatedLimits, EachStepObeysItsEquation) {
  std::mt19937 random(1);
  const auto number = [&](double most) { return std::uniform_real_distribution<double>(0, most)(random); };
  const auto vector = [&](double size) { return size * Vec3(number(2) - 1, number(2) - 1, number(2) - 1); };
  int moving = 0;
  for (int n = 0; n < 2000; ++n) {
    const ArmModel arm{.mass = 0.01 + number(0.1),
                       .coulomb_friction = number(0.4),
                       .viscous_friction = number(2),
                       .half_extent = Vec3(10)};
    const HandModel hand{.mass = number(0.1), .stiffness = number(900), .damping = number(8)};
    const Vec3 force = vector(3), target = vector(0.005), target_velocity = vector(0.2);
    const BodyState before{vector(0.005), vector(0.2)};
    const double dt = 5e-6 + number(45e-6);
    BodyState after = before;
    step_body(arm, hand, force, target, target_velocity, dt, after);
    EXPECT_LT(glm::distance(after.position, before.position + dt * after.velocity), 1e-15);
    // What friction has to be for this step, as a force.
    const Vec3 others = force - arm.viscous_friction * after.velocity + hand.stiffness * (target - after.position) +
                        hand.damping * (target_velocity - after.velocity);
    const Vec3 friction = (arm.mass + hand.mass) * (after.velocity - before.velocity) / dt - others;
    if (glm::length(after.velocity) > 0) {
      ++moving;
      const Vec3 wanted = -arm.coulomb_friction * glm::normalize(after.velocity);
      EXPECT_LT(glm::distance(friction, wanted), 1e-8) << n;
    } else {
      EXPECT_LE(glm::length(friction), arm.coulomb_friction * (1 + 1e-9)) << "it sticks";
    }
  }
  EXPECT_GT(moving, 500);
}

/// Each side of each axis has its stop, where the body stays.
TEST(SimulatedLimits, EachStopHolds) {
  const ArmModel arm{.half_extent = {0.05, 0.03, 0.02}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      BodyState body;
      Vec3 force(0);
      force[axis] = side * 100;
      for (int n = 0; n < 3000; ++n)
        step_body(arm, {.stiffness = 0, .damping = 0}, force, Vec3(0), Vec3(0), 50e-6, body);
      Vec3 stop(0);
      stop[axis] = side * arm.half_extent[axis];
      EXPECT_EQ(body.position, stop);
      EXPECT_EQ(body.velocity, Vec3(0));
    }
  }
}

/// S. Vigna's splitmix64, between 0 and 1 by its upper 53 bits.
double next_splitmix(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return std::ldexp(static_cast<double>((z ^ (z >> 31U)) >> 11U), -53);
}

/// The same everywhere: five sines for each axis, one in each fifth of the band, each with a phase of its own, of equal
/// amplitudes that add up to the tremor's mean square.
TEST(SimulatedLimits, TheTremorIsThatOfItsSeed) {
  for (const std::uint64_t seed : {1U, 7U, 123456789U}) {
    const HandModel hand{.tremor_rms = 0.08e-3, .tremor_lowest = 7, .tremor_highest = 13, .tremor_seed = seed};
    const Tremor tremor(hand);
    for (const double time : {0.0, 0.123, 4.5, 700.0}) {
      std::uint64_t random = seed;
      Vec3 wanted(0);
      for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 5; ++i) {
          const double hz = 7 + (i + next_splitmix(random)) * 6 / 5,
                       phase = 2 * std::numbers::pi * next_splitmix(random);
          wanted[axis] += 0.08e-3 * std::sqrt(2.0 / 5) * std::sin(2 * std::numbers::pi * hz * time + phase);
        }
      }
      EXPECT_LT(glm::distance(tremor(time), wanted), 1e-14) << seed << " " << time;
    }
  }
}

/// The hand goes after a live target no faster than it is said to, straight, and arrives.
TEST(SimulatedLimits, ALiveTargetIsFollowedAtItsSpeed) {
  for (const double speed : {0.1, 0.25}) {
    SimulatedDevice device = steady();
    device.target_speed = speed;
    device.arm.coulomb_friction = 0;
    SimulatedStylus stylus(device);
    stylus.open();
    const Vec3 target(0.03, -0.04, 0);
    stylus.move_target(target);
    for (int n = 0; n < 120; ++n) stylus.write_force(Vec3(0));
    const Vec3 before = stylus.body().position;
    for (int n = 0; n < 50; ++n) stylus.write_force(Vec3(0));
    EXPECT_NEAR(glm::distance(stylus.body().position, before), 0.05 * speed, 0.1 * 0.05 * speed);
    EXPECT_LT(glm::length(glm::cross(stylus.body().position, target)), 1e-9);
    for (int n = 0; n < 1000; ++n) stylus.write_force(Vec3(0));
    EXPECT_LT(glm::distance(stylus.body().position, target), 1e-6);
    EXPECT_EQ(stylus.read().buttons, 0U) << "none is pressed unless it is said";
    stylus.move_target(Vec3(std::nan(""), 0, 0), 7);
    for (int n = 0; n < 10; ++n) stylus.write_force(Vec3(0));
    EXPECT_LT(glm::distance(stylus.body().position, target), 1e-6) << "a place that is none is not gone to";
    EXPECT_EQ(stylus.read().buttons, 0U);
  }
}

/// What is not a number, and whatever is written after an unplugging, pushes nothing, and neither does what was on its
/// way.
TEST(SimulatedLimits, WhatIsNotANumberEndsAllForces) {
  for (const double odd : {std::nan(""), HUGE_VAL}) {
    for (int axis = 0; axis < 3; ++axis) {
      SimulatedDevice device = steady();
      device.delay = 20e-3;
      SimulatedStylus stylus(device);
      stylus.open();
      for (int n = 0; n < 30; ++n) stylus.write_force(Vec3(1, 2, 3));
      EXPECT_EQ(stylus.acting_force(), Vec3(1, 2, 3));
      Vec3 force(1, 2, 3);
      force[axis] = odd;
      for (int n = 0; n < 30; ++n) {
        stylus.write_force(force);
        EXPECT_EQ(stylus.acting_force(), Vec3(0));
      }
    }
  }
}

/// Before it is opened and after it was closed nothing acts and nothing moves; what it read last is what it tells.
TEST(SimulatedLimits, OneThatIsNotOpenStandsStill) {
  SimulatedStylus stylus(steady());
  const Waypoint path[] = {{0, {0.01, 0.02, 0.03}, 5}, {1, {0.05, 0, 0}, 6}};
  stylus.follow(path);
  const Reading never = stylus.read();
  EXPECT_FALSE(never.fresh);
  EXPECT_EQ(never.time, 0);
  EXPECT_EQ(never.position, Vec3(0));
  EXPECT_EQ(never.buttons, 0U);
  stylus.write_force(Vec3(1));
  EXPECT_EQ(stylus.acting_force(), Vec3(0));
  stylus.open();
  EXPECT_EQ(stylus.state(), State::idle);
  EXPECT_EQ(stylus.read().buttons, 5U);
  for (int n = 0; n < 50; ++n) stylus.write_force(Vec3(1));
  const Reading last = stylus.read();
  EXPECT_TRUE(last.fresh);
  EXPECT_FALSE(stylus.read().fresh) << "read twice in a tick";
  const BodyState body = stylus.body();
  stylus.close();
  EXPECT_EQ(stylus.state(), State::disconnected);
  EXPECT_EQ(stylus.acting_force(), Vec3(0));
  for (int n = 0; n < 50; ++n) stylus.write_force(Vec3(1));
  EXPECT_EQ(stylus.acting_force(), Vec3(0));
  EXPECT_EQ(stylus.body().position, body.position);
  EXPECT_EQ(stylus.read().position, last.position);
  EXPECT_EQ(stylus.read().time, last.time);
}

/// A hand's buttons are those of the waypoint that it comes from, and of the last one for ever.
TEST(SimulatedLimits, ButtonsAreThoseOfTheWaypointBefore) {
  SimulatedStylus stylus(steady());
  EXPECT_EQ(Waypoint{}.buttons, 0U) << "where none is named";
  const Waypoint path[] = {{0, Vec3(0), 1}, {0.0105, Vec3(0), 2}, {0.0205, Vec3(0), 4}};
  stylus.follow(path);
  stylus.open();
  for (int tick = 0; tick < 40; ++tick) {
    EXPECT_EQ(stylus.read().buttons, tick < 11 ? 1U : tick < 21 ? 2U : 4U) << tick;
    stylus.write_force(Vec3(0));
  }
}

/// The walls it bears are those of its own friction, damping, steps, rate and delay: each bound by its formula.
TEST(SimulatedLimits, ItsStiffnessLimitIsThatOfItsModel) {
  SimulatedDevice device;
  const auto limit = [&] { return SimulatedStylus(device).specification().stiffness_limit; };
  // 0.6 of the lesser of (0.3 + 4) / (0.5 ms + 0.5 ms) and 2 x 0.06 / 0.02 mm, which is 6000.
  EXPECT_NEAR(limit(), 0.6 * 4300, 1e-9);
  device.delay = 1e-3;
  EXPECT_NEAR(limit(), 0.6 * 4.3 / 1.5e-3, 1e-9);
  device.rate = 2000;
  EXPECT_NEAR(limit(), 0.6 * 4.3 / 1.25e-3, 1e-9);
  device.hand.damping = 2;
  EXPECT_NEAR(limit(), 0.6 * 2.3 / 1.25e-3, 1e-9);
  device.arm.viscous_friction = 0.1;
  EXPECT_NEAR(limit(), 0.6 * 2.1 / 1.25e-3, 1e-9);
  device.position_step = 0.1e-3;
  EXPECT_NEAR(limit(), 0.6 * 1200, 1e-9);
  device.arm.coulomb_friction = 0.03;
  EXPECT_NEAR(limit(), 0.6 * 600, 1e-9);
  device.delay = 0;
  device.rate = 20000;
  device.hand.damping = 20;
  device.position_step = 0;
  EXPECT_EQ(limit(), 3000) << "and never more";
}

/// The seed and the rate that were chosen.
TEST(SimulatedLimits, TheKindTakesWhatIsChosen) {
  const auto positions = [](const DeviceChoice& choice) {
    const auto stylus = find_device_type("simulated")->make(choice);
    EXPECT_EQ(stylus->specification().rate, choice.rate_hz);
    stylus->open();
    std::vector<double> all;
    for (int n = 0; n < 300; ++n) {
      all.push_back(stylus->read().position.x);
      stylus->write_force(Vec3(0));
    }
    return all;
  };
  EXPECT_EQ(positions({.seed = 3}), positions({.seed = 3}));
  EXPECT_NE(positions({.seed = 3}), positions({.seed = 4}));
  EXPECT_NE(positions({.rate_hz = 500}), positions({.rate_hz = 2000}));
}

}  // namespace
}  // namespace palpate::device
