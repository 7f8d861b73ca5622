#include "plugin/recording/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <memory>
#include <thread>

#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

TickRecord numbered(std::uint64_t n) {
  TickRecord tick;
  tick.index = n;
  tick.time_s = 1e-3 * static_cast<double>(n);
  tick.share_count = 1;
  return tick;
}

void push(TickRing& ring, std::uint64_t first, std::uint64_t count) {
  for (std::uint64_t n = first; n < first + count; ++n) {
    const PrimitiveRecord share{.tick = n};
    ring.push(numbered(n), {&share, 1});
  }
}

const RecordingHeader header{.palpate_version = "1.2.3", .device = "simulated", .scan_hash = "0123456789abcdef"};

TEST(Recorder, WritesEveryTickInOrderWithWhatTheSessionWasGiven) {
  const auto file = fresh_path("all.h5");
  TickRing ring(1024);
  Recorder recorder(ring, file, header);
  recorder.note(SceneRecord{.epoch = 0, .scene = R"({"a":"ü\n"})", .scan_hash = "x", .half_extent_m = {1, 2, 0.1}});
  recorder.note(StylusRecord{.epoch = 3, .name = "falcon", .force_axes = 3, .maximum_force_n = 8});
  for (std::uint64_t n = 0; n < 20000; n += 100) {
    recorder.wait_for_room();
    push(ring, n, 100);
  }
  const RecorderStatus status = recorder.finish();
  EXPECT_FALSE(status.stopped) << status.why;
  EXPECT_EQ(status.lost, 0U);
  const Recording recording = read_recording(file);
  EXPECT_TRUE(recording.complete);
  ASSERT_EQ(recording.ticks.size(), 20000U);
  for (std::uint64_t n = 0; n < 20000; ++n) {
    ASSERT_EQ(recording.ticks[n].index, n);
    ASSERT_EQ(recording.shares[n].tick, n);
  }
  ASSERT_EQ(recording.scenes.size(), 1U);
  EXPECT_EQ(recording.scenes[0].scene, R"({"a":"ü\n"})");
  EXPECT_EQ(recording.scenes[0].half_extent_m, glm::dvec3(1, 2, 0.1));
  ASSERT_EQ(recording.styluses.size(), 1U);
  EXPECT_EQ(recording.styluses[0].name, "falcon");
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".partial"));
}

TEST(Recorder, ThatIsDroppedLeavesAWholeRecording) {
  const auto file = fresh_path("dropped.h5");
  TickRing ring(1024);
  {
    Recorder recorder(ring, file, header);
    push(ring, 0, 300);
  }
  const Recording recording = read_recording(file);
  EXPECT_TRUE(recording.complete);
  EXPECT_EQ(recording.ticks.size(), 300U);
}

/// Each tick is asked of with its own shares, of the scene that it felt; one that is over is let go of.
TEST(Recorder, EachTickHasWhatIsKnownOfItsBoundary) {
  const auto file = fresh_path("known.h5");
  TickRing ring(1024);
  Recorder recorder(ring, file, header, {.most_behind = 1024});
  const auto first_scan = std::make_shared<int>(0), second_scan = std::make_shared<int>(0);
  recorder.note(SceneRecord{.epoch = 0}, [first_scan](const TickRecord& tick, auto shares) {
    return shares.size() == 1 && shares[0].tick == tick.index ? 0.5 : -1;
  });
  push(ring, 0, 100);
  recorder.note(SceneRecord{.epoch = 1},
                [second_scan](const TickRecord& tick, auto) { return static_cast<double>(tick.index); });
  for (std::uint64_t n = 100; n < 200; ++n) {
    TickRecord tick = numbered(n);
    tick.scene_epoch = 1;
    const PrimitiveRecord share{.tick = n};
    ring.push(tick, {&share, 1});
  }
  while (first_scan.use_count() > 1) std::this_thread::yield();  // no tick of it comes any more
  EXPECT_GT(second_scan.use_count(), 1);
  recorder.finish();
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.known_to_mm.size(), 200U);
  for (std::size_t n = 0; n < 100; ++n) ASSERT_EQ(recording.known_to_mm[n], 0.5) << n;
  for (std::size_t n = 100; n < 200; ++n) ASSERT_EQ(recording.known_to_mm[n], static_cast<double>(n));
}

TEST(Recorder, WhatItReachesTooLateIsRecordedWithoutTheFieldsBeingAsked) {
  const auto file = fresh_path("late.h5");
  TickRing ring(1024);
  int asked = 0;
  std::atomic<bool> pushed{false};
  const auto wait = [&pushed] {
    while (!pushed) std::this_thread::yield();
  };
  Recorder recorder(ring, file, header, {.most_behind = 100, .before_write = wait});
  recorder.note(SceneRecord{.epoch = 0}, [&asked](const TickRecord&, auto) {
    ++asked;
    return 0.25;
  });
  push(ring, 0, 600);
  pushed = true;
  recorder.finish();
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.ticks.size(), 600U);
  EXPECT_EQ(asked, 100);
  EXPECT_TRUE(std::isnan(recording.known_to_mm[499]));
  EXPECT_EQ(recording.known_to_mm[500], 0.25);
}

TEST(Recorder, ASlowDiskLosesNothingWithinTheBacklogAndMarksWhatItLosesBeyond) {
  const auto file = fresh_path("slow.h5");
  TickRing ring(1024);
  std::atomic<bool> held{true}, waits{false};
  Recorder recorder(ring, file, header, {.before_write = [&] {
                      waits = true;
                      while (held) std::this_thread::yield();
                    }});
  push(ring, 0, 1024);  // all that the ring holds, while the disk does not answer
  held = false;
  while (recorder.status().written < 1024) std::this_thread::yield();
  EXPECT_EQ(recorder.status().lost, 0U);
  held = true;
  waits = false;
  push(ring, 1024, 10);
  while (!waits) std::this_thread::yield();  // the batch of ten waits for the disk
  push(ring, 1034, 3000);
  held = false;
  const RecorderStatus status = recorder.finish();
  EXPECT_EQ(status.written + status.lost, 4034U);
  EXPECT_GE(status.lost, 4034U - 1024U - 1024U - 10U);
  const Recording recording = read_recording(file);
  EXPECT_EQ(recording.ticks.size(), status.written);
  ASSERT_FALSE(recording.gaps.empty());
  std::uint64_t marked = 0;
  for (const Gap& gap : recording.gaps) marked += gap.ticks;
  EXPECT_EQ(marked, status.lost);
  // Every number is in the file or in a gap.
  std::uint64_t next = 0;
  for (const TickRecord& tick : recording.ticks) {
    for (const Gap& gap : recording.gaps) next += gap.first_tick == next ? gap.ticks : 0;
    ASSERT_EQ(tick.index, next);
    ++next;
  }
  EXPECT_EQ(recording.ticks.back().index, 4033U);
}

TEST(Recorder, LittleRoomOnTheDiskEndsTheRecordingInGoodOrder) {
  const auto file = fresh_path("room.h5");
  TickRing ring(1024);
  Recorder recorder(ring, file, header, {.spare_bytes = std::uintmax_t{1} << 62U});
  push(ring, 0, 100);
  const RecorderStatus status = recorder.finish();
  EXPECT_TRUE(status.stopped);
  EXPECT_THAT(status.why, ::testing::HasSubstr("MiB are left"));
  EXPECT_EQ(status.written + status.lost, 100U);
  EXPECT_TRUE(read_recording(file).complete);
}

/// In a process of its own whose files may not grow beyond a megabyte: the disk refuses in the middle of a write.
TEST(Recorder, ADiskThatRefusesEndsTheRecordingAndNotTheSession) {
  const auto file = fresh_path("full.h5");
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit most{1U << 20U, 1U << 20U};
    setrlimit(RLIMIT_FSIZE, &most);
    TickRing ring(1U << 14U);
    Recorder recorder(ring, file, header);
    std::uint64_t n = 0;
    for (int i = 0; i < 1000 && !recorder.status().stopped; ++i) {
      recorder.wait_for_room();
      for (std::uint64_t k = 0; k < 1000; ++k, ++n) {
        TickRecord tick = numbered(n);
        tick.share_count = 0;
        tick.value = static_cast<double>(n * 0x9E3779B97F4A7C15U);  // does not pack well
        tick.force_n[0] = tick.value * 1.37;
        tick.force_n[1] = tick.value / 3;
        ring.push(tick, {});
      }
    }
    const RecorderStatus status = recorder.finish();
    _exit(status.stopped && status.lost > 0 && status.why.find("disk full") != std::string::npos ? 0 : 1);
  }
  int exit_status = 0;
  waitpid(child, &exit_status, 0);
  ASSERT_TRUE(WIFEXITED(exit_status)) << "signal " << WTERMSIG(exit_status);
  EXPECT_EQ(WEXITSTATUS(exit_status), 0);
  const Recording recording = read_recording(file.string() + ".partial");
  EXPECT_FALSE(recording.complete);
  for (std::uint64_t n = 0; n < recording.ticks.size(); ++n) ASSERT_EQ(recording.ticks[n].index, n);
}

/// A process whose clock flushes after each batch, and that is killed when it begins the batch after 25000 ticks.
TEST(Recorder, AfterACrashWhatWasFlushedCanBeRead) {
  const auto file = fresh_path("crash.h5");
  constexpr std::uint64_t flushed = 25000;
  const pid_t child = fork();
  if (child == 0) {
    TickRing ring(1U << 14U);
    std::atomic<bool> all{false};
    std::chrono::steady_clock::time_point time;
    Recorder recorder(ring, file, header,
                      {.before_write =
                           [&] {
                             if (all) kill(getpid(), SIGKILL);
                           },
                       .now = [&] { return time += std::chrono::seconds(2); }});
    recorder.note(SceneRecord{.epoch = 0, .scene = "{}", .scan_hash = "x"});
    for (std::uint64_t n = 0; n < flushed; n += 50) {
      recorder.wait_for_room();
      push(ring, n, 50);
    }
    while (recorder.status().written < flushed) std::this_thread::yield();
    all = true;
    push(ring, flushed, 50);
    for (;;) pause();
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const Recording recording = read_recording(file.string() + ".partial");
  EXPECT_FALSE(recording.complete);
  EXPECT_EQ(recording.ticks.size(), flushed);
  EXPECT_EQ(recording.ticks.size(), recording.shares.size());
  EXPECT_EQ(recording.scenes.size(), 1U);
  for (std::uint64_t n = 0; n < recording.ticks.size(); ++n) ASSERT_EQ(recording.ticks[n].index, n);
}

/// A second recorder goes on where the first one ended: no tick is in both files, and none is in neither.
TEST(Recorder, TheNextOneGoesOnWhereTheFirstEnded) {
  TickRing ring(1024);
  push(ring, 0, 20);
  const auto first_file = fresh_path("part 1.h5"), second_file = fresh_path("part 2.h5");
  Recorder first(ring, first_file, header, {.first_tick = 7});
  push(ring, 20, 30);
  EXPECT_EQ(first.finish().written, 43U);
  EXPECT_EQ(first.next(), 50U);
  push(ring, 50, 25);
  Recorder second(ring, second_file, header, {.first_tick = first.next()});
  push(ring, 75, 5);
  EXPECT_EQ(second.finish().written, 30U);
  std::uint64_t next = 7;
  for (const auto& file : {first_file, second_file}) {
    for (const TickRecord& tick : read_recording(file).ticks) ASSERT_EQ(tick.index, next++);
  }
  EXPECT_EQ(next, 80U);
}

}  // namespace
}  // namespace palpate::plugin
