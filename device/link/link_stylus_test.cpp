#include "device/link/link_stylus.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "device/testing/link_bench.h"

namespace palpate::device {
namespace {

TEST(LinkStylus, AThreadWhoseDeviceIsGoneDoesNotSpin) {
  LinkBench bench;
  LinkStylus stylus(pushing(), std::make_unique<LinkBenchDriver>(bench));
  stylus.open();
  while (bench.takes == 0) std::this_thread::yield();
  bench.lost = true;
  while (stylus.fault() != LinkFault::unplugged) std::this_thread::yield();
  const int before = bench.takes;
  const double begun = monotonic_time();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // how often in real time is what is asked here
  const int takes = bench.takes - before;
  EXPECT_LT(takes, 1e3 * (monotonic_time() - begun)) << "more than once a millisecond";
}

TEST(LinkStylus, NothingIsPushedAgainAfterTheMachineSlept) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 1, 0.3);
  ASSERT_EQ(bench.force, Vec3(0, 1, 0));
  asleep_s += 30;
  push(bench, *stylus, 1, 0.1);
  EXPECT_EQ(bench.force, Vec3(0));
  EXPECT_EQ(stylus->fault(), LinkFault::slept);
  EXPECT_EQ(stylus->state(), State::fault);
}

TEST(LinkStylus, NothingIsPushedAgainAfterTheProgramWasStopped) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 1, 0.1);
  bench.time = bench.time + 5;
  push(bench, *stylus, 1, 0.1);
  EXPECT_EQ(bench.force, Vec3(0));
  EXPECT_EQ(stylus->fault(), LinkFault::held_up);
}

TEST(LinkStylus, GivesForLongNoMoreThanTheContinuousForce) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 8, 2.5);
  EXPECT_DOUBLE_EQ(bench.force.y, 8);
  EXPECT_GT(stylus->allowed_force(), 8);
  push(bench, *stylus, 8, 20);
  EXPECT_NEAR(bench.force.y, 4, 0.05);
  EXPECT_NEAR(stylus->allowed_force(), bench.force.y, 0.05) << "what it gives can be told";
  push(bench, *stylus, 3, 1);
  EXPECT_DOUBLE_EQ(bench.force.y, 3);
  EXPECT_GT(stylus->allowed_force(), 4) << "the motors cool";
}

}  // namespace
}  // namespace palpate::device
