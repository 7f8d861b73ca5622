#include "plugin/session/servo.h"

#include <gtest/gtest.h>

#include <chrono>
#include <glm/geometric.hpp>
#include <thread>

#include "plugin/recording/recorder.h"
#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

Snapshot make_again(const SceneRecord& record) {
  return snapshot(record.scene, slab(record.scan_hash == "frame 1" ? 0.8 : 0.0));
}

void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// At the clock's pace, recorded, with scenes changed meanwhile: every deadline accounted for, nothing lost, and the
/// replay is the same.
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
  std::uint64_t ticks = 0, missed = 0;
  {
    Session session(make_again(scene), held, &ring);
    Servo servo(session, rate_hz);
    for (int n = 0; n < 12; ++n) {
      servo.heartbeat();
      if (n % 4 == 1) {
        scene = {scene.epoch + 1, n == 5 ? "ct-bone" : "ct-skin-and-bone", n == 9 ? "frame 1" : "frame 0"};
        recorder.note(scene);
        session.publish(make_again(scene));
      }
      sleep_s(0.1);
    }
    servo.stop();
    ticks = servo.ticks();
    missed = servo.missed();
  }
  const RecorderStatus status = recorder.finish();
  EXPECT_EQ(status.lost, 0U);
  EXPECT_EQ(status.written, ticks);
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.frames.size(), ticks);
  std::uint64_t missed_in_frames = 0;
  for (const TickRecord& frame : recording.frames) {
    missed_in_frames += frame.missed;
    // The time of a frame is its deadline: ticks and missed ones together.
    ASSERT_NEAR(frame.time_s * rate_hz, static_cast<double>(frame.index + missed_in_frames), 1e-6);
  }
  EXPECT_EQ(missed_in_frames, missed);
  EXPECT_GT(ticks + missed, static_cast<std::uint64_t>(1.1 * rate_hz));
  const Replay result = replay(recording, make_again);
  EXPECT_EQ(result.frames, ticks);
  EXPECT_EQ(result.different, 0U) << "first: " << result.first_different.value_or(0);
}

TEST(Servo, AKilohertzIsAccountedForAndReplayed) {
  run_at(1000);
}
TEST(Servo, TenKilohertzOnRequest) {
  run_at(10000);
}

TEST(Servo, ACommanderThatIsGoneLetsGo) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  Servo servo(session);
  for (int n = 0; n < 15; ++n) {
    servo.heartbeat();
    sleep_s(0.05);
  }
  sleep_s(2.8);
  servo.stop();
  EXPECT_TRUE(session.fault() == device::Fault::commander_silent || session.fault() == device::Fault::tick_late)
      << device::name_of(session.fault());
  EXPECT_EQ(glm::length(vector_of(session.tick({.time_s = 100, .heartbeat_s = 100}).sent_n)), 0);
}

TEST(Servo, RefusesARateThatNoServoHas) {
  Session session(snapshot("ct-skin-and-bone", slab()), stylus(hold()));
  EXPECT_THROW(Servo(session, 1e6), std::logic_error);
  EXPECT_THROW(Servo(session, 0), std::logic_error);
}

}  // namespace
}  // namespace palpate::plugin
