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

#include "device/testing/wooden_haptics_bench.h"

namespace palpate::device {
namespace {

using Bench = WoodenHapticsBench;

TEST(WoodenHapticsDriver, ShortReportsAreRefused) {
  Bench bench;
  bench.home();
  bench.arm.faults.short_every = 20;
  bench.run(1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none);
  EXPECT_LT(glm::length(bench.stylus->read().position - bench.arm.hand().body().position), 0.5e-3);
}

TEST(WoodenHapticsDriver, FaultsEndInZeros) {
  Bench impossible;
  impossible.home();
  impossible.run(0.1, Vec3(0, 1, 0));
  impossible.arm.faults.impossible_pose = true;
  impossible.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(impossible.stylus->fault(), LinkFault::unreachable_pose);
  EXPECT_FALSE(impossible.is_pushing());

  Bench unplugged;
  unplugged.home();
  unplugged.run(0.1, Vec3(0, 1, 0));
  unplugged.bench.unplugged = true;
  unplugged.run(0.01, Vec3(0, 1, 0));
  EXPECT_EQ(unplugged.stylus->fault(), LinkFault::unplugged);
  EXPECT_TRUE(unplugged.is_pushing()) << "nobody can reach it";
  unplugged.bench.time += 0.51;
  EXPECT_FALSE(unplugged.is_pushing()) << "its own watchdog of 0.5 s";

  Bench stalled;
  stalled.home();
  stalled.run(0.1, Vec3(0, 1, 0));
  for (int i = 0; i < 30; ++i) stalled.stylus->service(1e-3);
  EXPECT_FALSE(stalled.is_pushing());

  Bench closed;
  closed.home();
  closed.run(0.1, Vec3(0, 1, 0));
  ASSERT_TRUE(closed.is_pushing());
  closed.stylus->close();
  EXPECT_FALSE(closed.is_pushing());
}

TEST(WoodenHapticsDriver, ADeviceThatDoesNotAnswerIsRefused) {
  Bench bench;
  bench.arm.faults.silent = true;
  EXPECT_THROW(bench.stylus->open(), std::runtime_error);
  EXPECT_EQ(bench.stylus->state(), State::disconnected);
}

TEST(WoodenHapticsDriver, KeepsItsHomeWhenItIsOpenedAgain) {
  for (const std::size_t size : {8U, 14U}) {
    FakeWoodenHapticsOptions options;
    options.report_size = size;
    options.arm = arm_with_home_at(Vec3(0), size);
    options.path = {{0.5, {0, 0, 0}}, {0.8, {0.04, -0.03, 0.03}}};
    Bench bench(options);
    bench.stylus->open();
    bench.run(1.2);
    bench.stylus->close();
    bench.stylus->open();
    bench.run(0.1, Vec3(0, 1, 0));
    ASSERT_EQ(bench.stylus->state(), State::idle) << size;
    EXPECT_LT(glm::distance(bench.stylus->read().position, bench.arm.hand().body().position), 0.2e-3) << size;
    EXPECT_LT(glm::distance(bench.arm.force(), Vec3(0, 1, 0)), 0.02) << size;
  }
}

TEST(WoodenHapticsDriver, AnUnpluggedArmHasToBeHomedAgain) {
  Bench bench;
  bench.home();
  bench.bench.unplugged = true;
  bench.run(0.01);
  bench.stylus->close();
  bench.bench.unplugged = false;
  bench.stylus->open();
  bench.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->state(), State::homing);
  EXPECT_FALSE(bench.is_pushing());
}

TEST(WoodenHapticsDriver, AnotherArmThanThePresetIsRefused) {
  FakeWoodenHapticsOptions options;
  options.report_size = 8;
  options.arm = arm_with_home_at(Vec3(0), 14);
  Bench bench(options);
  try {
    bench.stylus->open();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("reports of 8 bytes, which the preset 2015 does not have"));
  }
}

TEST(WoodenHapticsDriver, MotorsAreNotHeatedForLong) {
  Bench bench;
  bench.home();
  const auto strongest = [&] {
    const auto& milliamperes = bench.arm.milliamperes();
    return std::max({std::abs(milliamperes[0]), std::abs(milliamperes[1]), std::abs(milliamperes[2])});
  };
  bench.run(1, Vec3(0, 5, 0));
  EXPECT_GT(strongest(), 1900) << "short-term, to the limit of the current";
  bench.run(15, Vec3(0, 5, 0));
  EXPECT_LT(strongest(), 1010) << "for long, to the continuous current";
  EXPECT_GT(strongest(), 900);
}

}  // namespace
}  // namespace palpate::device
