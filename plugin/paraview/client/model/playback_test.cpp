// A recording in the views: where it is after which presses, against the recording's own ticks.

#include "plugin/paraview/client/model/playback.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <thread>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/session/scan_hash.h"
#include "testdata/phantom.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr double tick_s = 0.01;

/// 2 s in ticks of 10 ms. Each number of a tick tells which one it is. Each scene is felt equally long.
std::shared_ptr<const RecordedSession> two_seconds(const std::vector<modes::Scene>& scenes = {
                                                       modes::load_scene("ct-skin-and-bone")}) {
  const io::Volume scan = testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(16)}));
  Recording recording;
  for (std::size_t n = 0; n < scenes.size(); ++n) {
    recording.scenes.push_back(
        {.epoch = static_cast<std::uint32_t>(n), .scene = modes::to_json(scenes[n]), .scan_hash = hash_of(scan)});
  }
  for (int n = 0; n <= 200; ++n) {
    TickRecord tick;
    tick.scene_epoch = static_cast<std::uint32_t>(static_cast<std::size_t>(n) * scenes.size() / 201);
    tick.index = static_cast<std::uint64_t>(n);
    tick.time_s = 3 + tick_s * n;
    tick.value = n;
    tick.probe_m[0] = 1e-4 * n;
    tick.proxy_m[1] = 2e-4 * n;
    tick.sent_n[0] = 0.003 * n;
    tick.sent_n[1] = 0.004 * n;
    tick.stage_ns[0] = 1000U * static_cast<std::uint32_t>(n);
    tick.share_count = 1;
    recording.shares.push_back({.tick = tick.index, .strength_n = 1.0 * n});
    recording.ticks.push_back(tick);
    recording.known_to_mm.push_back(0);
  }
  return std::make_shared<const RecordedSession>(std::move(recording), scan);
}

struct PlaybackTest : ::testing::Test {
  PlaybackTest() { playback.set_session(session); }
  /// The number of the tick that is shown.
  int shown() { return static_cast<int>(playback.look("HU").tick.index); }

  std::shared_ptr<const RecordedSession> session = two_seconds();
  Playback playback;
};

TEST_F(PlaybackTest, NothingIsShownBeforeAPress) {
  EXPECT_FALSE(playback.look("HU").is_seen());
  EXPECT_FALSE(playback.is_playing());
  EXPECT_EQ(playback.at_s(), 0);
  playback.seek(0);
  EXPECT_TRUE(playback.look("HU").is_seen());
  EXPECT_FALSE(playback.is_playing()) << "it is moved, not played";
}

TEST_F(PlaybackTest, EachPlaceShowsItsTick) {
  for (const int n : {0, 1, 77, 199, 200}) {
    playback.seek(tick_s * (n + 0.4));
    const SessionStatus look = playback.look("HU");
    ASSERT_EQ(look.tick.index, static_cast<std::uint64_t>(n));
    EXPECT_TRUE(look.fresh && look.replayed);
    EXPECT_FALSE(look.connected || look.feels);
    EXPECT_EQ(look.probe_mm, session->probe_mm(look.tick.index));
    EXPECT_EQ(look.proxy_mm, session->proxy_mm(look.tick.index));
    EXPECT_EQ(look.workspace, session->workspace(look.tick.index));
    EXPECT_NEAR(glm::distance(look.probe_mm, session->probe_mm(0)), 0.1 * n, 1e-9);
    EXPECT_NEAR(look.force_n, 0.005 * n, 1e-12);
    EXPECT_EQ(look.peak_n, look.force_n);
    EXPECT_NEAR(look.tick_us, n, 1e-9);
    ASSERT_EQ(look.shares.size(), 1U);
    EXPECT_EQ(look.shares[0].strength_n, n);
    ASSERT_NE(look.scene, nullptr);
    EXPECT_EQ(look.scene->name, session->scene(0).name);
    EXPECT_EQ(look.tissue, n < 100 ? "soft tissue" : look.tissue);
  }
}

/// A recording may have several scenes. Each place is named by the scene that was felt there.
TEST_F(PlaybackTest, EachPlaceIsNamedByItsOwnScene) {
  const modes::Scene usual = modes::load_scene("ct-skin-and-bone");
  std::vector<modes::Scene> scenes(3, usual);
  for (std::size_t n = 0; n < scenes.size(); ++n) {
    scenes[n].name = "scene " + std::to_string(n);
    scenes[n].tissues = {
        {.name = "tissue " + std::to_string(n), .low = -1000, .high = 1000, .softness = 10, .color = {}}};
  }
  playback.set_session(two_seconds(scenes));
  for (const int n : {0, 66, 67, 133, 134, 200, 70, 10}) {
    playback.seek(tick_s * (n + 0.4));
    const SessionStatus look = playback.look("HU");
    const std::string number = std::to_string(n / 67);
    ASSERT_NE(look.scene, nullptr);
    EXPECT_EQ(look.scene->name, "scene " + number) << n;
    EXPECT_EQ(look.tissue, "tissue " + number) << n;
  }
}

TEST_F(PlaybackTest, NoPlaceIsOutsideTheRecording) {
  playback.seek(-1);
  EXPECT_EQ(playback.at_s(), 0);
  playback.seek(99);
  EXPECT_NEAR(playback.at_s(), 2, 1e-9);
  EXPECT_EQ(shown(), 200);
}

TEST_F(PlaybackTest, ItRunsAsTheClockDoesTimesItsSpeed) {
  for (const double speed : {0.5, 1.0, 4.0}) {
    playback.seek(0.1);
    playback.set_speed(speed);
    const Clock::time_point before = Clock::now();
    playback.play();
    EXPECT_TRUE(playback.is_playing());
    const Clock::time_point began = Clock::now();
    std::this_thread::sleep_for(milliseconds(60));
    const double least_s = std::chrono::duration<double>(Clock::now() - began).count();
    (void)playback.look("HU");
    const double most_s = std::chrono::duration<double>(Clock::now() - before).count();
    constexpr double rounded_s = 2e-3;  // its clock counts milliseconds
    EXPECT_GE(playback.at_s(), std::min(2.0, 0.1 + speed * (least_s - rounded_s))) << speed;
    EXPECT_LE(playback.at_s(), 0.1 + speed * (most_s + rounded_s)) << speed;
    playback.pause();
    const double at_s = playback.at_s();
    std::this_thread::sleep_for(milliseconds(20));
    (void)playback.look("HU");
    EXPECT_EQ(playback.at_s(), at_s) << "it stays where it was paused";
  }
}

TEST_F(PlaybackTest, AnotherSpeedAppliesFromThenOn) {
  playback.set_speed(0);
  playback.play();
  std::this_thread::sleep_for(milliseconds(60));
  playback.set_speed(1);
  EXPECT_EQ(playback.at_s(), 0) << "the time before was at the speed before";
  std::this_thread::sleep_for(milliseconds(5));
  (void)playback.look("HU");
  EXPECT_GT(playback.at_s(), 0);
}

/// The time before a jump does not count.
TEST_F(PlaybackTest, AJumpWhileItPlaysIsToThePlaceAskedFor) {
  playback.play();
  std::this_thread::sleep_for(milliseconds(150));
  const Clock::time_point before = Clock::now();
  playback.seek(1);
  (void)playback.look("HU");
  EXPECT_GE(playback.at_s(), 1);
  EXPECT_LE(playback.at_s(), 1 + std::chrono::duration<double>(Clock::now() - before).count() + 2e-3);
  EXPECT_EQ(playback.is_playing(), playback.at_s() < 2);
}

TEST_F(PlaybackTest, ItEndsAtItsEndAndBeginsAnewFromThere) {
  playback.set_speed(1000);
  playback.play();
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(shown(), 200);
  EXPECT_FALSE(playback.is_playing());
  EXPECT_NEAR(playback.at_s(), 2, 1e-9);
  playback.set_speed(0);
  playback.play();
  EXPECT_EQ(playback.at_s(), 0);
  EXPECT_TRUE(playback.is_playing());
}

TEST_F(PlaybackTest, AnotherRecordingBeginsPausedAndUnseen) {
  playback.seek(1);
  playback.play();
  playback.set_session(session);
  EXPECT_FALSE(playback.is_playing());
  EXPECT_EQ(playback.at_s(), 0);
  EXPECT_FALSE(playback.look("HU").is_seen());
  playback.set_session(nullptr);
  playback.play();
  playback.seek(1);
  EXPECT_FALSE(playback.is_playing());
  EXPECT_FALSE(playback.look("HU").is_seen());
}

}  // namespace
}  // namespace palpate::plugin
