#include "device/safety/fault_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate::device {
namespace {

TEST(FaultLog, KeepsTheFramesAroundTheFirstFault) {
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
  EXPECT_EQ(log.frames().size(), FaultLog::capacity);
  record(1, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  const double fault_time = input.time;
  record(2000, Vec3(0, 1, 0));
  ASSERT_TRUE(log.stopped());

  const auto frames = log.frames();
  ASSERT_EQ(frames.size(), FaultLog::capacity);
  const SafetyFrame& at_fault = frames[FaultLog::capacity - FaultLog::frames_after_fault - 1];
  EXPECT_EQ(at_fault.input.time, fault_time);
  EXPECT_TRUE(std::isnan(at_fault.input.force.x));
  EXPECT_EQ(at_fault.result.fault, Fault::force_not_finite);
  EXPECT_EQ((&at_fault - 1)->result.force, Vec3(0, 1, 0));
  for (std::size_t i = 1; i < frames.size(); ++i) EXPECT_GT(frames[i].input.time, frames[i - 1].input.time);
  log.clear();
  EXPECT_TRUE(log.frames().empty());
  EXPECT_FALSE(log.stopped());
}

}  // namespace
}  // namespace palpate::device
