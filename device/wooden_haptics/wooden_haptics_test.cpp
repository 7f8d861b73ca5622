#include "device/wooden_haptics/wooden_haptics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include "device/testing/wall_ringing.h"
#include "device/testing/wooden_haptics_bench.h"

namespace palpate::device {
namespace {

using Bench = WoodenHapticsBench;

TEST(WoodenHapticsDriver, IsCalibratedByItsButtonAndFollowsTheHand) {
  for (const std::size_t size : {14U, 64U}) {
    FakeWoodenHapticsOptions options;
    options.report_size = size;
    options.path = {{0.3, {0, 0, 0}}, {0.6, {0.02, -0.03, 0.01}}};
    Bench bench(options);
    bench.stylus->open();
    bench.run(0.1, Vec3(0, 2, 0));
    EXPECT_EQ(bench.stylus->state(), State::homing);
    EXPECT_EQ(bench.arm.pushed_until(), 0) << "no force before calibration";
    bench.run(0.9);
    EXPECT_EQ(bench.stylus->state(), State::idle);
    EXPECT_LT(glm::length(bench.stylus->read().position - bench.arm.hand().body().position), 0.1e-3);
    EXPECT_GT(bench.arm.outputs(), 900U) << "a report and an answer every millisecond";
    EXPECT_LE(bench.arm.outputs(), 1010U);
  }
}

TEST(WoodenHapticsDriver, SpeaksTheShortReportsOf2016) {
  FakeWoodenHapticsOptions options;
  options.report_size = 8;
  options.arm = arm_with_home_at(Vec3(0), 8);
  Bench bench(options);
  bench.stylus->open();
  bench.run(0.4, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->state(), State::idle);
  EXPECT_LT(glm::length(bench.stylus->read().position - bench.arm.hand().body().position), 0.2e-3);
  EXPECT_LT(glm::length(bench.arm.force() - Vec3(0, 1, 0)), 0.02);
}

/// haptikfabrikenapi's host takes 10000 off a fourth encoder above 5000 and calls that a pressed button.
TEST(WoodenHapticsDriver, AButtonOnTheStylusComesWithTheFourthEncoder) {
  for (const bool has_button : {true, false}) {
    FakeWoodenHapticsOptions options;
    options.arm.stylus_button = has_button;
    Bench bench(options);
    bench.home();
    for (const int turn : {-4000, 0, 4000}) {
      bench.arm.faults.fourth_encoder = turn;
      bench.run(0.01);
      EXPECT_EQ(bench.stylus->read().buttons, 0U) << turn;
      bench.arm.faults.fourth_encoder = turn + 10000;
      bench.run(0.01);
      EXPECT_EQ(bench.stylus->read().buttons, has_button ? 1U : 0U) << turn;
    }
  }
}

TEST(WoodenHapticsDriver, TheHandFeelsTheForceAskedFor) {
  Bench bench;
  bench.home();
  for (const Vec3& force : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0.5, 0.5, -1)}) {
    bench.run(0.4, force);
    EXPECT_LT(glm::length(bench.arm.force() - force), 0.02);
    EXPECT_GT(glm::dot(bench.stylus->read().position, force), 0) << "the simulated hand relaxes";
  }
}

/// How far the hand still moves on a wall of this stiffness (N/m), m.
double ringing(double stiffness, double friction) {
  FakeWoodenHapticsOptions options;
  options.friction = friction;
  options.path = {{0.3, {0, 0, 0}}, {0.5, {0, 0.005, 0}}, {1.0, {0, -0.002, 0}}};
  Bench bench(options);
  bench.home();
  return ringing_of_wall(bench, bench.arm.hand(), stiffness);
}

TEST(WoodenHapticsDriver, AWallAtItsStiffnessLimitIsQuiet) {
  const double limit = Bench().stylus->specification().stiffness_limit;
  EXPECT_LT(ringing(limit, 0.06), 0.15e-3) << "tremor alone";
  // Whatever a real one's friction: without any, a stiffer wall lets less of the tremor through, until it rings.
  EXPECT_LT(ringing(limit, 0), ringing(limit / 2, 0));
  EXPECT_LT(ringing(1.5 * limit, 0), ringing(limit, 0)) << "and there is a margin";
  EXPECT_GT(ringing(4 * limit, 0), 3 * ringing(limit, 0)) << "or nothing could be seen here";
}

TEST(WoodenHapticsDriver, APoseIsFreshOnce) {
  Bench bench;
  bench.home();
  int fresh = 0;
  bench.run(0.5, [&](const Reading& reading) {
    fresh += reading.fresh ? 1 : 0;
    EXPECT_FALSE(bench.stylus->read().fresh);
    return Vec3(0);
  });
  EXPECT_GT(fresh, 300);
}

/// No safety filter here, and a current limit that would allow more: what limits is the driver.
TEST(WoodenHapticsDriver, HoldsItsOwnForceLimit) {
  FakeWoodenHapticsOptions options;
  options.arm.maximum_force = 1.5;
  Bench bench(options);
  bench.home();
  EXPECT_EQ(bench.stylus->specification().maximum_force, 1.5);
  bench.run(0.3, Vec3(1, 0, 1));  // the link's ramp after homing
  for (const Vec3& force : {Vec3(1, 0, 1), Vec3(2, 0, 0), Vec3(0, -2.5, 1), Vec3(0, 0, 1.7)}) {
    bench.run(0.05, force);
    const Vec3 expected = force * std::min(1.0, 1.5 / glm::length(force));
    EXPECT_LT(glm::length(bench.arm.force() - expected), 0.02) << force.x << ' ' << force.y << ' ' << force.z;
  }
  EXPECT_LT(glm::length(bench.arm.strongest_force()), 1.52);
}

TEST(WoodenHapticsDriver, ComesUpAtAnyTimeOfTheClock) {
  Bench bench;
  bench.bench.time = 5000;
  bench.stylus->open();
  bench.run(0.1);
  EXPECT_GT(bench.arm.reports(), 50U);
  EXPECT_NE(bench.stylus->state(), State::fault);
}

TEST(WoodenHapticsDriver, StartsAFirmwareThatWaits) {
  Bench bench;
  bench.home();
  bench.arm.faults.drop_every = 50;  // the firmware then blocks until it is sent something
  bench.run(1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none);
  EXPECT_GT(bench.arm.outputs(), 700U);
}

}  // namespace
}  // namespace palpate::device
