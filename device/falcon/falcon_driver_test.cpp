#include "device/falcon/falcon_driver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "device/testing/falcon_bench.h"
#include "device/testing/wall_ringing.h"

namespace palpate::device {
namespace {

using Bench = FalconBench;

TEST(FalconDriver, HomesAndThenKnowsWhereTheGripIs) {
  Bench bench;
  bench.stylus->open();
  EXPECT_EQ(bench.stylus->state(), State::homing);
  bench.run(0.2, [&](const Reading& reading) {
    EXPECT_EQ(reading.position, Vec3(0)) << "no pose before homing";
    return Vec3(0, 2, 0);
  });
  EXPECT_FALSE(bench.fake.falcon.is_pushing()) << "no force before homing";
  EXPECT_EQ(bench.fake.falcon.pushed_until(), 0);
  bench.run(0.8);
  ASSERT_EQ(bench.stylus->state(), State::idle);
  const Vec3 grip = bench.fake.falcon.hand().body().position;
  EXPECT_LT(glm::length(bench.stylus->read().position - grip), 0.1e-3);
  EXPECT_EQ(bench.fake.falcon.packets_with_other_size(), 0);
}

TEST(FalconDriver, TheCentreButtonIsTheFirstOneToo) {
  for (const std::uint32_t pressed : {1U, 2U, 4U, 8U}) {
    FakeFalconOptions options;
    options.path = {{0.05, {0, 0, 0}}, {0.30, {0, 0, 0.039}}, {0.60, {0, 0, 0}, pressed}};
    Bench bench(options);
    bench.home();
    EXPECT_EQ(bench.stylus->read().buttons, pressed == 4 ? 5U : pressed);
  }
}

TEST(FalconDriver, ExchangesAlmostAThousandPacketsASecond) {
  Bench bench;
  bench.home();
  const std::uint64_t before = bench.fake.falcon.commands();
  int fresh = 0;
  bench.run(1, [&](const Reading& reading) {
    fresh += reading.fresh ? 1 : 0;
    return Vec3(0);
  });
  EXPECT_GT(bench.fake.falcon.commands() - before, 900U);
  EXPECT_LE(bench.fake.falcon.commands() - before, 1100U);
  EXPECT_GT(fresh, 850);
}

TEST(FalconDriver, TheGripFeelsTheForceAskedFor) {
  Bench bench;
  bench.home();
  for (const Vec3& force : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0.5, 0.5, -1)}) {
    bench.run(0.5, force);
    EXPECT_LT(glm::length(bench.fake.falcon.force() - force), 0.01);
    EXPECT_GT(glm::dot(bench.stylus->read().position, force), 0) << "the simulated hand relaxes";
  }
}

/// How far the hand still moves on a wall of this stiffness (N/m), m.
double ringing(double stiffness, double friction) {
  FakeFalconOptions options;
  options.friction = friction;
  options.path = {{0.05, {0, 0, 0}}, {0.30, {0, 0, 0.039}}, {0.60, {0, 0.005, 0}}, {1.2, {0, -0.002, 0}}};
  Bench bench(options);
  bench.home();
  return ringing_of_wall(bench, bench.fake.falcon.hand(), stiffness);
}

TEST(FalconDriver, AWallAtItsStiffnessLimitIsQuiet) {
  const double limit = Bench().stylus->specification().stiffness_limit;
  EXPECT_LT(ringing(limit, 0.06), 0.15e-3) << "tremor alone";
  // Whatever a real one's friction: without any, a stiffer wall lets less of the tremor through, until it rings.
  EXPECT_LT(ringing(limit, 0), ringing(limit / 2, 0));
  EXPECT_LT(ringing(1.5 * limit, 0), ringing(limit, 0)) << "and there is a margin";
  EXPECT_GT(ringing(2 * limit, 0), 3 * ringing(limit, 0)) << "or nothing could be seen here";
}

TEST(FalconDriver, AHugeForceSaturatesInItsDirection) {
  Bench bench;
  bench.home();
  bench.run(0.05, Vec3(300, 400, 0));
  const Vec3 felt = bench.fake.falcon.force();
  int largest = 0;
  for (const int motor : bench.fake.falcon.motors()) largest = std::max(largest, std::abs(motor));
  EXPECT_EQ(largest, falcon_motor_limit);
  EXPECT_GT(glm::length(felt), 5) << "about 6 N is what the motors can do sideways, at the gain that is assumed";
  EXPECT_LE(glm::length(felt), 8.01);
  EXPECT_NEAR(glm::dot(glm::normalize(felt), Vec3(0.6, 0.8, 0)), 1, 1e-3);
  bench.run(0.03, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
}

/// A dead pose is told by this alone: what was read is not fresh when it is read again.
TEST(FalconDriver, APoseIsFreshOnce) {
  Bench bench;
  bench.home();
  int fresh = 0;
  bench.run(0.5, [&](const Reading& reading) {
    fresh += reading.fresh ? 1 : 0;
    const Reading again = bench.stylus->read();
    EXPECT_FALSE(again.fresh);
    EXPECT_EQ(again.position, reading.position);
    return Vec3(0);
  });
  EXPECT_GT(fresh, 400);
  bench.fake.falcon.faults.silent = true;
  bench.run(0.002);
  bench.stylus->read();
  bench.run(0.05, [&](const Reading& reading) {
    EXPECT_FALSE(reading.fresh);
    return Vec3(0);
  });
}

/// No safety filter here, and motors that could do three times as much: what limits is the driver.
TEST(FalconDriver, HoldsItsOwnForceLimit) {
  FalconSettings settings;
  settings.maximum_force = 2;
  Bench bench({}, settings);
  bench.home();
  EXPECT_EQ(bench.stylus->specification().maximum_force, 2);
  for (const Vec3& force : {Vec3(1, 0, 1), Vec3(3, 0, 0), Vec3(0, -2.5, 1), Vec3(1e6, 1e6, -1e6), Vec3(0, 0, 2.2)}) {
    bench.run(0.05, force);
    const Vec3 expected = force * std::min(1.0, 2 / glm::length(force));
    EXPECT_LT(glm::length(bench.fake.falcon.force() - expected), 0.02) << force.x << ' ' << force.y << ' ' << force.z;
  }
  EXPECT_LT(glm::length(bench.fake.falcon.strongest_force()), 2.02);
}

}  // namespace
}  // namespace palpate::device
