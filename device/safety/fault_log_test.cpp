#include "device/safety/fault_log.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

namespace palpate::device {
namespace {

TEST(FaultLog, KeepsTheTicksAroundTheFirstFault) {
  FaultLog log;
  SafetyState state;
  SafetyInput input;
  const auto record = [&](int ticks, const Vec3& force) {
    for (int i = 0; i < ticks; ++i) {
      input.time += 1e-3;
      input.reading.fresh = true;
      input.force = force;
      input.force_time = input.heartbeat_time = input.time;
      log.record(input, filter_force(SafetyLimits{}, input, state));
    }
  };
  arm(state);
  record(3000, Vec3(0, 1, 0));
  EXPECT_FALSE(log.stopped());
  EXPECT_EQ(log.ticks().size(), FaultLog::capacity);
  record(1, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  const double fault_time = input.time;
  record(2000, Vec3(0, 1, 0));
  ASSERT_TRUE(log.stopped());

  const auto ticks = log.ticks();
  ASSERT_EQ(ticks.size(), FaultLog::capacity);
  const SafetyTick& at_fault = ticks[FaultLog::capacity - FaultLog::ticks_after_fault - 1];
  EXPECT_EQ(at_fault.input.time, fault_time);
  EXPECT_TRUE(std::isnan(at_fault.input.force.x));
  EXPECT_EQ(at_fault.result.fault, Fault::force_not_finite);
  EXPECT_EQ((&at_fault - 1)->result.force, Vec3(0, 1, 0));
  for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_GT(ticks[i].input.time, ticks[i - 1].input.time);
  log.clear();
  EXPECT_TRUE(log.ticks().empty());
  EXPECT_FALSE(log.stopped());
}

/// A log of ticks with these faults, one after another.
struct Recorded {
  FaultLog log;
  double time = 0;
  void record(int ticks, Fault fault) {
    for (int i = 0; i < ticks; ++i) {
      SafetyInput input;
      input.time = time += 1e-3;
      SafetyResult result;
      result.fault = fault;
      log.record(input, result);
    }
  }
};

/// At 1 kHz, 0.1 s beside the tick of the fault itself.
TEST(FaultLog, GoesOnForATenthOfASecondAfterAFault) {
  Recorded one;
  one.record(500, Fault::none);
  one.record(100, Fault::device_lost);
  EXPECT_FALSE(one.log.stopped());
  one.record(1, Fault::device_lost);
  EXPECT_TRUE(one.log.stopped());
  one.record(1, Fault::device_lost);
  EXPECT_EQ(one.log.ticks().size(), 601U);
}

TEST(FaultLog, AFaultThatIsStillLatchedIsRecordedOnce) {
  Recorded one;
  one.record(500, Fault::none);
  one.record(300, Fault::speed_exceeded);
  ASSERT_TRUE(one.log.stopped());
  one.log.clear();
  one.record(500, Fault::speed_exceeded);
  EXPECT_FALSE(one.log.stopped());
  one.record(10, Fault::none);
  EXPECT_FALSE(one.log.stopped());
  one.record(300, Fault::device_lost);
  ASSERT_TRUE(one.log.stopped());
  EXPECT_EQ(one.log.ticks().back().result.fault, Fault::device_lost);
}

TEST(FaultLog, AFaultThatIsClearedAtOnceIsKeptAllTheSame) {
  Recorded one;
  one.record(500, Fault::none);
  one.record(20, Fault::force_stale);
  EXPECT_FALSE(one.log.stopped());
  one.record(1, Fault::none);
  ASSERT_TRUE(one.log.stopped());
  EXPECT_EQ(one.log.ticks().size(), 521U);
}

// With the thread sanitizer it also tells whether the two threads share the ring without a race.
TEST(FaultLog, IsReadAndClearedByAnotherThread) {
  Recorded one;
  std::atomic<bool> done{false};
  std::thread servo([&] {
    while (!done.load(std::memory_order_relaxed)) {
      one.record(5, Fault::none);
      one.record(20, Fault::force_stale);
    }
  });
  for (int n = 0; n < 50; ++n) {
    while (!one.log.stopped()) std::this_thread::yield();
    const auto ticks = one.log.ticks();
    EXPECT_GE(ticks.size(), 21U);
    EXPECT_EQ(ticks.back().result.fault, Fault::none) << "the fault was cleared";
    for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_GT(ticks[i].input.time, ticks[i - 1].input.time);
    one.log.clear();
  }
  done = true;
  servo.join();
}

}  // namespace
}  // namespace palpate::device
