#include "plugin/recording/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

TickRecord numbered(std::uint64_t n) {
  TickRecord frame;
  frame.index = n;
  frame.time_s = 1e-3 * static_cast<double>(n);
  frame.share_count = 1;
  return frame;
}

void push(TickRing& ring, std::uint64_t first, std::uint64_t count) {
  for (std::uint64_t n = first; n < first + count; ++n) {
    const PrimitiveRecord share{.frame = n};
    ring.push(numbered(n), {&share, 1});
  }
}

const RecordingHeader header{.palpate_version = "1.2.3", .device = "simulated", .scan_hash = "0123456789abcdef"};

TEST(Recorder, WritesEveryFrameInOrderWithWhatTheSessionWasGiven) {
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
  ASSERT_EQ(recording.frames.size(), 20000U);
  for (std::uint64_t n = 0; n < 20000; ++n) {
    ASSERT_EQ(recording.frames[n].index, n);
    ASSERT_EQ(recording.shares[n].frame, n);
  }
  ASSERT_EQ(recording.scenes.size(), 1U);
  EXPECT_EQ(recording.scenes[0].scene, R"({"a":"ü\n"})");
  EXPECT_EQ(recording.scenes[0].half_extent_m, glm::dvec3(1, 2, 0.1));
  ASSERT_EQ(recording.styluses.size(), 1U);
  EXPECT_EQ(recording.styluses[0].name, "falcon");
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".partial"));
}

TEST(Recorder, ASlowDiskLosesNothingWithinTheBacklogAndMarksWhatItLosesBeyond) {
  const auto file = fresh_path("slow.h5");
  TickRing ring(1024);
  std::atomic<bool> held{true};
  Recorder recorder(ring, file, header, {.before_write = [&] {
                      while (held) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                    }});
  push(ring, 0, 1024);  // all that the ring holds, while the disk does not answer
  held = false;
  while (recorder.status().written < 1024) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(recorder.status().lost, 0U);
  held = true;
  push(ring, 1024, 10);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));  // the batch of ten waits for the disk
  push(ring, 1034, 3000);
  held = false;
  const RecorderStatus status = recorder.finish();
  EXPECT_EQ(status.written + status.lost, 4034U);
  EXPECT_GE(status.lost, 4034U - 1024U - 1024U - 10U);
  const Recording recording = read_recording(file);
  EXPECT_EQ(recording.frames.size(), status.written);
  ASSERT_FALSE(recording.gaps.empty());
  std::uint64_t marked = 0;
  for (const Gap& gap : recording.gaps) marked += gap.frames;
  EXPECT_EQ(marked, status.lost);
  // Every number is in the file or in a gap.
  std::uint64_t next = 0;
  for (const TickRecord& frame : recording.frames) {
    for (const Gap& gap : recording.gaps) next += gap.first_frame == next ? gap.frames : 0;
    ASSERT_EQ(frame.index, next);
    ++next;
  }
  EXPECT_EQ(recording.frames.back().index, 4033U);
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
        TickRecord frame = numbered(n);
        frame.share_count = 0;
        frame.value = static_cast<double>(n * 0x9E3779B97F4A7C15U);  // does not pack well
        frame.force_n[0] = frame.value * 1.37;
        frame.force_n[1] = frame.value / 3;
        ring.push(frame, {});
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
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
  for (std::uint64_t n = 0; n < recording.frames.size(); ++n) ASSERT_EQ(recording.frames[n].index, n);
}

TEST(Recorder, AfterACrashWhatWasFlushedCanBeRead) {
  const auto file = fresh_path("crash.h5");
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    TickRing ring(1U << 14U);
    Recorder recorder(ring, file, header);
    recorder.note(SceneRecord{.epoch = 0, .scene = "{}", .scan_hash = "x"});
    for (std::uint64_t n = 0;; n += 50) {
      push(ring, n, 50);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (n == 25000) {
        [[maybe_unused]] const auto sent = write(ready[1], "x", 1);
      }
    }
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const Recording recording = read_recording(file.string() + ".partial");
  EXPECT_FALSE(recording.complete);
  EXPECT_GT(recording.frames.size(), 5000U) << "two and a half seconds, flushed every second";
  EXPECT_EQ(recording.frames.size(), recording.shares.size());
  EXPECT_EQ(recording.scenes.size(), 1U);
  for (std::uint64_t n = 0; n < recording.frames.size(); ++n) ASSERT_EQ(recording.frames[n].index, n);
}

}  // namespace
}  // namespace palpate::plugin
