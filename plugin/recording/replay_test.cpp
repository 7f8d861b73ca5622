#include "plugin/recording/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "plugin/recording/recorder.h"
#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

/// Scans by hash, as a session finds them again.
Snapshot make_again(const SceneRecord& record) {
  return snapshot(record.scene, slab(record.scan_hash == "frame 1" ? 0.8 : 0.0));
}

/// A session in which everything happens: scenes, time frames, styluses, faults, a commander that falls silent.
Recording eventful_session(const std::filesystem::path& file) {
  const auto held = stylus(press());
  TickRing ring;
  Recorder recorder(ring, file, {.rate_hz = 1000});
  const auto note_stylus = [&](std::uint32_t epoch, const device::Specification& what) {
    recorder.note(StylusRecord{epoch, what.name, what.force_axes, what.maximum_force});
  };
  SceneRecord scene{.epoch = 0, .scene = "ct-skin-and-bone", .scan_hash = "frame 0"};
  recorder.note(scene);
  note_stylus(0, held->specification());
  Session session(make_again(scene), held, &ring);
  const auto publish = [&](const std::string& name, const std::string& scan) {
    scene = {.epoch = scene.epoch + 1, .scene = name, .scan_hash = scan};
    recorder.note(scene);
    EXPECT_EQ(session.publish(make_again(scene)), scene.epoch);
  };
  for (int n = 0; n < 8000; ++n) {
    switch (n) {
      case 2200:
        publish("ct-skin-and-bone", "frame 1");
        break;
      case 2300:  // waits for the change on its way, and never comes
        publish("ct-vessels", "frame 1");
        publish("ct-bone", "frame 0");
        break;
      case 3700:
        held->inject(device::SimulatedFault::not_a_number);
        break;
      case 3702:
        held->inject(device::SimulatedFault::none);
        session.clear_fault();
        session.arm();
        break;
      case 4300:
        held->inject(device::SimulatedFault::unplugged);
        break;
      case 4400:
        note_stylus(1, device::Specification{.name = "none"});
        session.change_stylus(nullptr);
        break;
      case 4450:
        session.collect();
        held->inject(device::SimulatedFault::none);
        note_stylus(2, held->specification());
        session.change_stylus(held);
        session.clear_fault();
        session.arm();
        break;
      default:
        break;
    }
    const double time = 1e-3 * n;
    session.tick({.time_s = time, .heartbeat_s = n > 5500 ? 5.5 : time, .missed = n % 7 == 0 ? 1U : 0U});
  }
  EXPECT_FALSE(recorder.finish().stopped);
  return read_recording(file);
}

TEST(Replay, AnEventfulSessionIsTheSameToTheLastBit) {
  const Recording recording = eventful_session(fresh_path("eventful.h5"));
  ASSERT_EQ(recording.ticks.size(), 8000U);
  std::map<std::uint32_t, int> faults, scenes, styluses;
  for (const TickRecord& tick : recording.ticks) {
    ++faults[static_cast<std::uint32_t>(fault_of(tick))];
    ++scenes[tick.scene_epoch];
    ++styluses[tick.stylus_epoch];
  }
  EXPECT_EQ(faults.size(), 4U) << "none, a pose that is no number, a lost device, a silent commander";
  EXPECT_EQ(scenes.size(), 3U) << "0, 1 and 3: 2 was never taken";
  EXPECT_EQ(styluses.size(), 3U);
  const Replay result = replay(recording, make_again);
  EXPECT_EQ(result.ticks, 8000U);
  EXPECT_EQ(result.different, 0U) << "first: " << result.first_different.value_or(0);
  EXPECT_EQ(result.largest_force_n, 0);
  EXPECT_EQ(result.largest_proxy_m, 0);
}

TEST(Replay, FindsTheTickThatDiffers) {
  Recording recording = eventful_session(fresh_path("differs.h5"));
  recording.ticks[3000].proxy_m[1] += 1e-9;
  const Replay result = replay(recording, make_again);
  EXPECT_EQ(result.different, 1U);
  EXPECT_EQ(result.first_different, 3000U);
  EXPECT_NEAR(result.largest_proxy_m, 1e-9, 1e-14);
  // Another scan is another session from the first touch on.
  const Replay other = replay(recording, [](const SceneRecord& record) { return snapshot(record.scene, slab(0.4)); });
  EXPECT_GT(other.different, 100U);
  EXPECT_GT(other.largest_proxy_m, 1e-5);
}

/// The largest differences are those of the whole recording, whatever comes after them and wherever numbers are
/// missing.
TEST(Replay, ADifferenceIsNotForgottenAfterOneThatIsNoNumber) {
  const Recording original = eventful_session(fresh_path("nan.h5"));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const int axis : {0, 1, 2}) {
    Recording recording = original;
    recording.ticks[2000].proxy_m[axis] += 1e-2;
    recording.ticks[2000].sent_n[axis] -= 0.5;
    EXPECT_NEAR(replay(recording, make_again).largest_proxy_m, 1e-2, 1e-14);
    EXPECT_NEAR(replay(recording, make_again).largest_force_n, 0.5, 1e-14);
    recording.ticks[3000].proxy_m[axis] = nan;
    recording.ticks[3000].sent_n[axis] = nan;
    recording.ticks[5000].proxy_m[axis] += 1e-9;
    recording.ticks[5000].sent_n[axis] += 1e-9;
    const Replay result = replay(recording, make_again);
    EXPECT_EQ(result.different, 3U);
    EXPECT_EQ(result.first_different, 2000U);
    EXPECT_EQ(result.largest_proxy_m, infinity);
    EXPECT_EQ(result.largest_force_n, infinity);
  }
}

/// What two builds may differ by is the sum of the two bounds of one tick; a tick without a bound excuses nothing.
TEST(Replay, TellsTheLargestBoundOfTheTwoTogether) {
  Recording recording = eventful_session(fresh_path("bound.h5"));
  double largest_own = 0;
  Recording without = recording;
  for (TickRecord& tick : without.ticks) {
    if (std::isfinite(tick.error_bound_m)) largest_own = std::max(largest_own, tick.error_bound_m);
    tick.error_bound_m = 0;
  }
  EXPECT_GT(largest_own, 0);
  EXPECT_EQ(replay(without, make_again).largest_bound_m, largest_own) << "the repeated ones alone";
  const double own = recording.ticks[3000].error_bound_m;  // the repeated one's
  recording.ticks[3000].error_bound_m = 1e-3;
  EXPECT_NEAR(replay(recording, make_again).largest_bound_m, 1e-3 + own, 1e-15);
  recording.ticks[3500].error_bound_m = std::numeric_limits<double>::infinity();
  recording.ticks[3600].error_bound_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(replay(recording, make_again).largest_bound_m, 1e-3 + own, 1e-15);
}

TEST(Replay, StopsAtTheFirstGapAndSaysHowManyCameAfter) {
  Recording recording = eventful_session(fresh_path("gap.h5"));
  recording.ticks.erase(recording.ticks.begin() + 1000, recording.ticks.begin() + 1200);
  const Replay result = replay(recording, make_again);
  EXPECT_EQ(result.ticks, 1000U);
  EXPECT_EQ(result.different, 0U);
  EXPECT_EQ(result.after_gap, 6800U);
}

TEST(Replay, RefusesARecordingThatLacksItsScene) {
  Recording recording = eventful_session(fresh_path("lacks.h5"));
  recording.scenes.pop_back();
  EXPECT_THROW(replay(recording, make_again), std::runtime_error);
}

}  // namespace
}  // namespace palpate::plugin
