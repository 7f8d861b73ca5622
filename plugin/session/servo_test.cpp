#include "plugin/session/servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "plugin/recording/recorder.h"
#include "plugin/testing/session_rig.h"
#include "plugin/testing/test_clocks.h"

namespace palpate::plugin {
namespace {

using namespace testing;

Snapshot make_again(const SceneRecord& record) {
  return snapshot(record.scene, slab(record.scan_hash == "frame 1" ? 0.8 : 0.0));
}

/// Recorded, with scenes changed meanwhile and a deadline or three missed: every deadline is accounted for, nothing is
/// lost, and the replay is the same.
void run_at(double rate_hz) {
  const auto file = fresh_path("servo.h5");
  device::SimulatedDevice model;
  model.rate = rate_hz;
  const auto held = std::make_shared<device::SimulatedStylus>(model);
  held->follow(hold());
  TickRing ring;
  Recorder recorder(ring, file, {.rate_hz = rate_hz});
  SceneRecord scene{.epoch = 0, .scene = "ct-skin-and-bone", .scan_hash = "frame 0"};
  recorder.note(scene);
  const device::Specification specification = held->specification();
  recorder.note(StylusRecord{0, specification.name, specification.force_axes, specification.maximum_force});
  const auto tenth_of_a_second = static_cast<std::uint64_t>(rate_hz / 10);
  {
    Session session(make_again(scene), held, &ring);
    DrivenTime time;
    Servo servo(session, time.clock(), 1 / rate_hz);
    for (int n = 0; n < 12; ++n) {
      servo.heartbeat();
      if (n % 4 == 1) {
        scene = {scene.epoch + 1, n == 5 ? "ct-bone" : "ct-skin-and-bone", n == 9 ? "frame 1" : "frame 0"};
        recorder.note(scene);
        session.publish(make_again(scene));
      }
      if (n % 5 == 2) time.skip(static_cast<std::uint64_t>(n));
      time.advance(tenth_of_a_second);
    }
    servo.stop();
    EXPECT_EQ(servo.ticks(), 12 * tenth_of_a_second);
    EXPECT_EQ(servo.missed(), 2U + 7U);
  }
  const RecorderStatus status = recorder.finish();
  EXPECT_EQ(status.lost, 0U);
  EXPECT_EQ(status.written, 12 * tenth_of_a_second);
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.ticks.size(), 12 * tenth_of_a_second);
  std::uint64_t missed = 0;
  for (const TickRecord& tick : recording.ticks) {
    const bool was_skipped = tick.index == 2 * tenth_of_a_second || tick.index == 7 * tenth_of_a_second;
    ASSERT_EQ(tick.missed, was_skipped ? tick.index / tenth_of_a_second : 0);
    missed += tick.missed;
    // The time of a tick is its deadline: ticks and missed ones together.
    ASSERT_NEAR(tick.time_s * rate_hz, static_cast<double>(tick.index + missed), 1e-6);
  }
  const Replay result = replay(recording, make_again);
  EXPECT_EQ(result.ticks, recording.ticks.size());
  EXPECT_EQ(result.different, 0U) << "first: " << result.first_different.value_or(0);
}

TEST(Servo, AKilohertzIsAccountedForAndReplayed) {
  run_at(1000);
}
TEST(Servo, TenKilohertzOnRequest) {
  run_at(10000);
}

TEST(Servo, TheComputersClockAccountsForEveryDeadline) {  // however busy the machine is
  TickRing ring;
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()), &ring);
  const double began_s = device::monotonic_time();
  Servo servo(session);
  while (servo.ticks() < 50) std::this_thread::yield();
  servo.stop();
  EXPECT_LE(static_cast<double>(servo.ticks() + servo.missed()), (device::monotonic_time() - began_s) * 1000 + 1);
  TickRecord last;
  ASSERT_TRUE(ring.read(ring.written() - 1, last));
  EXPECT_NEAR(last.time_s * 1000, static_cast<double>(servo.ticks() + servo.missed() - 1), 1e-6);
}

/// A clock that says how late each tick is, in turn.
struct LateClock : ServoClock {
  explicit LateClock(std::vector<double> late_s) : late(std::move(late_s)) {}
  Deadline wait(std::uint64_t) noexcept override {
    if (next == late.size()) return {.due = false};
    return {.late_s = late[next++]};
  }
  std::vector<double> late;
  std::size_t next = 0;
};

/// What a tick says of how late it was is the clock's, in nanoseconds: never below zero, and 4 s stand for more.
TEST(Servo, ATickSaysHowLateItBegan) {
  TickRing ring;
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()), &ring);
  Servo servo(session, std::make_unique<LateClock>(std::vector{0.0, 25e-9, 1.5e-3, -1e-3, 3.0, 4.5, 1e9}), 1e-3);
  while (servo.ticks() < 7) std::this_thread::yield();
  servo.stop();
  const std::vector<std::uint32_t> wanted{0, 25, 1'500'000, 0, 3'000'000'000, 4'000'000'000, 4'000'000'000};
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    TickRecord tick;
    ASSERT_TRUE(ring.read(n, tick));
    EXPECT_NEAR(tick.late_ns, wanted[n], 1) << n;
  }
}

TEST(Servo, TheForceGoesTwoSecondsAfterTheLastHeartbeat) {
  TickRing ring;
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()), &ring);
  DrivenTime time;
  Servo servo(session, time.clock(), 1e-3);
  for (int n = 0; n < 15; ++n) {
    servo.heartbeat();
    time.advance(50);
  }
  const auto fault_and_force = [&] {
    TickRecord last;
    ring.read(ring.written() - 1, last);
    return std::pair(session.fault(), glm::length(vector_of(last.sent_n)));
  };
  time.advance(1950);  // 1.999 s since the last heartbeat, which the tick after it saw
  EXPECT_EQ(session.fault(), device::Fault::none);
  EXPECT_GT(fault_and_force().second, 0.3);
  time.advance(2);
  EXPECT_EQ(session.fault(), device::Fault::commander_silent);
  EXPECT_GT(fault_and_force().second, 0.1) << "ramped, not stepped";
  time.advance(static_cast<std::uint64_t>(std::lround(device::SafetyLimits().ramp_time * 1000)) + 1);
  EXPECT_EQ(fault_and_force().second, 0);
  servo.heartbeat();
  time.advance(1000);
  EXPECT_EQ(fault_and_force().second, 0) << "until a person clears the fault";
}

TEST(Servo, RefusesARateThatNoServoHas) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  EXPECT_THROW(Servo(session, 1e6), std::logic_error);
  EXPECT_THROW(Servo(session, 0), std::logic_error);
}

}  // namespace
}  // namespace palpate::plugin
