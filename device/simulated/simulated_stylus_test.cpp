#include "device/simulated/simulated_stylus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <vector>

namespace palpate::device {
namespace {

SimulatedDevice without_tremor() {
  SimulatedDevice device;
  device.hand.tremor_rms = 0;
  return device;
}

TEST(SimulatedStylus, RestsWhereTheHandRests) {
  SimulatedStylus stylus(without_tremor());
  const Waypoint path[] = {{0, {0.01, 0.02, -0.03}}};
  stylus.follow(path);
  stylus.open();
  for (int i = 0; i < 1000; ++i) {
    const Reading reading = stylus.read();
    EXPECT_TRUE(reading.fresh);
    EXPECT_DOUBLE_EQ(reading.time, i * 1e-3);
    EXPECT_NEAR(glm::length(reading.position - path[0].position), 0, 1e-12);
    stylus.write_force(Vec3(0));
  }
}

TEST(SimulatedStylus, ForcesMoveItByForceOverTheHandsStiffness) {
  SimulatedDevice device = without_tremor();
  device.position_step = 0;
  device.arm.coulomb_friction = 0;
  SimulatedStylus stylus(device);
  stylus.open();
  for (int i = 0; i < 2000; ++i) {
    stylus.read();
    stylus.write_force(Vec3(1, -2, 0.5));
  }
  EXPECT_NEAR(glm::length(stylus.read().position - Vec3(1, -2, 0.5) / 500.0), 0, 1e-9);
}

/// Whatever was felt before: opened again, closed meanwhile or not, it is as new.
TEST(SimulatedStylus, OpenedAgainItIsAsNew) {
  for (const bool closed : {true, false}) {
    SimulatedStylus fresh(without_tremor()), used(without_tremor());
    fresh.open();
    used.open();
    for (int i = 0; i < 300; ++i) {
      used.read();
      used.write_force(Vec3(5, -3, 2));
    }
    if (closed) used.close();
    used.open();
    for (int i = 0; i < 50; ++i) {
      ASSERT_EQ(used.read().position, fresh.read().position) << i;
      ASSERT_EQ(used.body().position, fresh.body().position) << i;
      for (SimulatedStylus* stylus : {&used, &fresh}) stylus->write_force(i < 20 ? Vec3(0) : Vec3(1, 0, 0));
    }
  }
}

/// No safety filter here: the hand moves by the force that the device can give, over the hand's stiffness.
TEST(SimulatedStylus, HoldsItsOwnForceLimit) {
  SimulatedDevice device = without_tremor();
  device.position_step = 0;
  device.arm.coulomb_friction = 0;
  device.maximum_force = 2;
  for (const Vec3& force : {Vec3(1, 1, 0.5), Vec3(3, 0, 4), Vec3(0, -1e6, 1e6)}) {
    SimulatedStylus stylus(device);
    stylus.open();
    for (int i = 0; i < 2000; ++i) {
      stylus.read();
      stylus.write_force(force);
    }
    const Vec3 expected = force * std::min(1.0, 2 / glm::length(force));
    EXPECT_NEAR(glm::length(stylus.read().position - expected / 500.0), 0, 1e-9);
  }
}

TEST(SimulatedStylus, FrictionHoldsBackNoMoreThanItsForce) {
  SimulatedStylus stylus(without_tremor());
  stylus.open();
  for (int i = 0; i < 500; ++i) {
    stylus.read();
    stylus.write_force(Vec3(0.059, 0, 0));
  }
  EXPECT_EQ(stylus.body().position, Vec3(0)) << "sticks exactly";
  for (int i = 0; i < 2000; ++i) {
    stylus.read();
    stylus.write_force(Vec3(0.56, 0, 0));
  }
  EXPECT_EQ(stylus.body().velocity, Vec3(0));
  EXPECT_LE(std::abs(0.56 - 500 * stylus.body().position.x), 0.06) << "comes to rest where friction can hold it";
}

TEST(SimulatedStylus, ReadsInSteps) {
  SimulatedStylus stylus;
  const Waypoint path[] = {{0, {0, 0, 0}}, {1, {0.02, -0.01, 0.005}}};
  stylus.follow(path);
  stylus.open();
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 position = stylus.read().position;
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = position[axis] / 0.02e-3;
      ASSERT_NEAR(steps, std::round(steps), 1e-9);
      worst = std::max(worst, std::abs(position[axis] - stylus.body().position[axis]));
    }
    stylus.write_force(Vec3(0));
  }
  EXPECT_LE(worst, 0.01e-3 + 1e-12);
  EXPECT_GT(worst, 0.008e-3);
}

TEST(SimulatedStylus, AForceActsHalfATickLateAndIsHeldForATick) {
  // A free mass: the velocity tells how long the force has acted.
  SimulatedDevice device = without_tremor();
  device.hand.stiffness = device.hand.damping = device.hand.mass = 0;
  device.arm.coulomb_friction = device.arm.viscous_friction = 0;
  SimulatedStylus stylus(device);
  stylus.open();
  stylus.write_force(Vec3(0.9, 0, 0));
  EXPECT_NEAR(stylus.body().velocity.x, 0.9 / 0.045 * 0.5e-3, 1e-12);
  stylus.write_force(Vec3(0));
  EXPECT_NEAR(stylus.body().velocity.x, 0.9 / 0.045 * 1e-3, 1e-12);
  stylus.write_force(Vec3(0));
  EXPECT_NEAR(stylus.body().velocity.x, 0.9 / 0.045 * 1e-3, 1e-12);
}

TEST(SimulatedStylus, NeverGivesEnergyByItself) {
  // Without friction, damping or force the spring and the mass keep at most what they had, and lose little of it.
  SimulatedDevice device = without_tremor();
  device.hand.damping = 0;
  device.arm.coulomb_friction = device.arm.viscous_friction = 0;
  device.position_step = 0;
  SimulatedStylus stylus(device);
  stylus.open();
  const auto energy = [&] {
    const BodyState& body = stylus.body();
    return 0.5 * 0.095 * glm::dot(body.velocity, body.velocity) + 0.5 * 500 * glm::dot(body.position, body.position);
  };
  for (int i = 0; i < 20; ++i) stylus.write_force(Vec3(2, 1, 0));
  stylus.write_force(Vec3(0));
  const double start = energy();
  double previous = start;
  for (int i = 0; i < 87; ++i) {  // one period of sqrt(500 / 0.095) rad/s
    stylus.write_force(Vec3(0));
    ASSERT_LE(energy(), previous * (1 + 1e-12));
    previous = energy();
  }
  EXPECT_GT(previous, 0.97 * start) << "the integrator's own damping, w h / 2 = 0.002 of critical, stays small";
}

TEST(SimulatedStylus, SwingsAsTheEquationSays) {
  // Underdamped free oscillation towards a displaced target, against its closed form.
  SimulatedDevice device = without_tremor();
  device.position_step = 0;
  device.arm.coulomb_friction = 0;
  SimulatedStylus stylus(device);
  stylus.open();
  const double m = 0.095;
  const double b = 4.3;
  const double k = 500;
  const double decay = b / (2 * m);
  const double w = std::sqrt(k / m - decay * decay);
  for (int i = 0; i < 300; ++i) {
    stylus.write_force(Vec3(0, 1, 0));
    const double t = (i + 1) * 1e-3 - 0.5e-3;
    const double expected = 1 / k * (1 - std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t)));
    ASSERT_NEAR(stylus.body().position.y, expected, 0.01 / k) << i;
  }
}

TEST(SimulatedStylus, TremorHasItsSizeAndItsBand) {
  HandModel hand;
  const Tremor tremor(hand);
  Vec3 squares(0);
  const int n = 60'000;
  int crossings = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3 d = tremor(i * 1e-3);
    squares += d * d;
    crossings += tremor((i + 1) * 1e-3).x > 0 && d.x <= 0 ? 1 : 0;
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(squares[axis] / n), 0.05e-3, 0.005e-3);
  EXPECT_GT(crossings, 8 * 60);
  EXPECT_LT(crossings, 12 * 60);
  hand.tremor_seed = 2;
  EXPECT_NE(Tremor(hand)(0.1), tremor(0.1));
}

TEST(SimulatedStylus, RepeatsBitForBit) {
  const Waypoint path[] = {{0, {0, 0.01, 0}}, {1, {0.02, -0.01, 0.01}}};
  std::vector<Vec3> runs[2];
  SimulatedStylus reopened;
  for (int run = 0; run < 2; ++run) {
    reopened.follow(path);
    reopened.open();
    for (int i = 0; i < 2000; ++i) {
      const Vec3 position = reopened.read().position;
      runs[run].push_back(reopened.body().position);
      reopened.write_force(Vec3(0, std::max(0.0, -400 * position.y), 0));
    }
    reopened.close();
  }
  EXPECT_TRUE(runs[0] == runs[1]);
}

TEST(SimulatedStylus, TenKilohertzIsTheSameHand) {
  SimulatedDevice slow = without_tremor();
  SimulatedDevice fast = slow;
  fast.rate = 10'000;
  Vec3 at_end[2];
  int which = 0;
  for (const SimulatedDevice& device : {slow, fast}) {
    SimulatedStylus stylus(device);
    const Waypoint path[] = {{0, {0, 0, 0}}, {0.3, {0.02, 0, 0}}};
    stylus.follow(path);
    stylus.open();
    for (int i = 0; i < 0.2 * device.rate; ++i) stylus.write_force(Vec3(0, 0.5, 0));
    at_end[which++] = stylus.body().position;
  }
  EXPECT_NEAR(glm::length(at_end[0] - at_end[1]), 0, 2e-5);
}

TEST(SimulatedStylus, GoesAfterALiveTargetAtAHandsSpeed) {
  SimulatedStylus stylus(without_tremor());
  stylus.open();
  stylus.move_target(Vec3(0.05, 0, 0), 1);
  double fastest = 0;
  for (int i = 0; i < 1000; ++i) {
    stylus.write_force(Vec3(0));
    fastest = std::max(fastest, glm::length(stylus.body().velocity));
  }
  const Reading reading = stylus.read();
  EXPECT_NEAR(reading.position.x, 0.05, 0.2e-3);
  EXPECT_EQ(reading.buttons, 1U);
  EXPECT_LT(fastest, 0.4);
}

TEST(SimulatedStylus, IsStillAtItsLiveTargetWhenOpenedAgain) {
  SimulatedStylus stylus(without_tremor());
  stylus.open();
  stylus.move_target(Vec3(0.05, 0.01, 0), 1);
  for (int i = 0; i < 1000; ++i) stylus.write_force(Vec3(0));
  stylus.close();
  stylus.open();
  const Reading reading = stylus.read();
  EXPECT_NEAR(glm::length(reading.position - Vec3(0.05, 0.01, 0)), 0, 0.02e-3);
  EXPECT_EQ(reading.buttons, 1U);
}

TEST(SimulatedStylus, StopsAtTheEndOfItsArm) {
  SimulatedStylus stylus;
  const Waypoint path[] = {{0, {0, 0, 0}}, {0.5, {0.5, 0, 0}}};
  stylus.follow(path);
  stylus.open();
  for (int i = 0; i < 1000; ++i) stylus.write_force(Vec3(0));
  EXPECT_NEAR(stylus.read().position.x, 0.08, 1e-9);
}

/// A quarter of the way in a quarter of the time, or a tenth (10/64 - 15/256 + 6/1024) where it starts from rest.
TEST(SimulatedStylus, FollowsItsPathAsItIsAskedTo) {
  const Waypoint path[] = {{0, {0, 0, 0}}, {1, {0.02, 0, 0}}};
  for (const PathInterpolation how : {PathInterpolation::linear, PathInterpolation::minimum_jerk}) {
    SimulatedStylus stylus(without_tremor());
    stylus.follow(path, how);
    stylus.open();
    for (int i = 0; i < 250; ++i) stylus.write_force(Vec3(0));
    const double share = how == PathInterpolation::linear ? 0.25 : 0.103515625;
    EXPECT_NEAR(stylus.body().position.x, share * 0.02, 0.5e-3);
  }
}

TEST(SimulatedStylus, FaultsOnDemand) {
  SimulatedStylus stylus(without_tremor());
  const Waypoint path[] = {{0, {0, 0, 0}}, {1, {0.05, 0, 0}}};
  stylus.follow(path);
  stylus.open();
  const auto tick = [&](const Vec3& force = Vec3(0)) {
    const Reading reading = stylus.read();
    stylus.write_force(force);
    return reading;
  };
  for (int i = 0; i < 300; ++i) tick(Vec3(0, 1, 0));
  stylus.inject(SimulatedFault::not_a_number);
  EXPECT_TRUE(std::isnan(tick().position.x));
  stylus.inject(SimulatedFault::none);
  EXPECT_TRUE(std::isfinite(tick(Vec3(0, 1, 0)).position.x));

  stylus.inject(SimulatedFault::stalled);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(tick().fresh);
  EXPECT_EQ(stylus.acting_force(), Vec3(0, 1, 0)) << "a stalled device holds its last force";

  stylus.inject(SimulatedFault::unplugged);
  stylus.write_force(Vec3(0, 1, 0));
  EXPECT_EQ(stylus.acting_force(), Vec3(0)) << "from the next force on, though no pose was read that tells of it";
  EXPECT_FALSE(tick(Vec3(0, 1, 0)).fresh);
  EXPECT_EQ(stylus.state(), State::fault);
  EXPECT_EQ(stylus.acting_force(), Vec3(0));
  stylus.close();
  EXPECT_THROW(stylus.open(), std::runtime_error);
  stylus.inject(SimulatedFault::none);
  stylus.open();
  EXPECT_EQ(stylus.state(), State::idle);
}

TEST(SimulatedStylus, RefusesWhatNoDeviceCanBe) {
  SimulatedDevice device;
  device.arm.mass = 0;
  EXPECT_THROW(SimulatedStylus{device}, std::invalid_argument);
  device = {};
  device.delay = 1;
  EXPECT_THROW(SimulatedStylus{device}, std::invalid_argument);
  device = {};
  device.rate = 0;
  EXPECT_THROW(SimulatedStylus{device}, std::invalid_argument);
}

TEST(SimulatedStylus, OpenedAnewAndStalledItTellsNoPoseOfBefore) {
  SimulatedStylus stylus;
  const Waypoint away[] = {{0, {0.01, 0.02, 0.03}}};
  stylus.follow(away);
  stylus.open();
  EXPECT_GT(glm::length(stylus.read().position), 0.03);
  stylus.close();
  stylus.inject(SimulatedFault::stalled);
  stylus.open();
  EXPECT_EQ(stylus.read().position, Vec3(0));
  EXPECT_FALSE(stylus.read().fresh);
}

}  // namespace
}  // namespace palpate::device
