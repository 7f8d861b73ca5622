/// When a recorder flushes, waits, ends and counts, with a clock and a disk controlled by the test.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>

#include "io/testing/file_bytes.h"
#include "plugin/recording/recorder.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::fresh_path;

void push_ticks(TickRing& ring, std::uint64_t count) {
  for (std::uint64_t n = 0; n < count; ++n) {
    TickRecord tick;
    tick.index = ring.written();
    ring.push(tick, {});
  }
}

/// Time that goes on only when a test says so.
struct HeldClock {
  std::atomic<std::int64_t> ms{5000};
  std::function<std::chrono::steady_clock::time_point()> now() {
    return [this] { return std::chrono::steady_clock::time_point(std::chrono::milliseconds(ms)); };
  }
};

/// A disk that answers only when a test says so.
struct HeldDisk {
  std::atomic<bool> answers{true};
  std::function<void()> before_write() {
    return [this] {
      while (!answers) std::this_thread::yield();
    };
  }
};

void await_written(const Recorder& recorder, std::uint64_t ticks) {
  while (recorder.status().written < ticks) std::this_thread::yield();
}

/// Somebody who waits for room, and most likely already does when this has been made.
class Waiting {
 public:
  explicit Waiting(Recorder& recorder)
      : thread_([this, &recorder] {
          begun_ = true;
          recorder.wait_for_room();
          backlog_ = recorder.backlog();
        }) {
    while (!begun_) std::this_thread::yield();
    for (int n = 0; n < 200; ++n) {
      recorder.status();
      std::this_thread::yield();
    }
  }
  /// What there was when it came back.
  std::uint64_t backlog_after() {
    thread_.join();
    return backlog_;
  }

 private:
  std::atomic<bool> begun_{false};
  std::uint64_t backlog_ = 0;
  std::thread thread_;
};

/// Once a second and not before: what a crash would leave are the ticks until the last flush. What follows a batch is
/// over when the next batch is written.
TEST(RecorderClock, FlushesOnceASecond) {
  const auto file = fresh_path("flushed.h5");
  const std::filesystem::path partial = file.string() + ".partial";
  TickRing ring(1024);
  HeldClock clock;
  Recorder recorder(ring, file, {}, {.now = clock.now()});
  recorder.note(SceneRecord{}, [](const TickRecord& tick, auto) { return static_cast<double>(tick.index) + 0.5; });
  std::uint64_t ticks = 0;
  const auto write_one = [&] {
    push_ticks(ring, 1);
    await_written(recorder, ++ticks);
  };
  const auto left_by_a_crash = [&] {  // a copy: HDF5 would look into the writer's own memory
    const auto left = fresh_path("left.h5");
    std::filesystem::copy_file(partial, left);
    return read_recording(left).ticks.size();
  };
  write_one();
  write_one();
  EXPECT_EQ(left_by_a_crash(), 0U);
  clock.ms += 999;
  write_one();
  write_one();
  EXPECT_EQ(left_by_a_crash(), 0U);
  clock.ms += 1;
  write_one();
  write_one();
  const std::size_t first = left_by_a_crash();
  EXPECT_GE(first, 4U);
  clock.ms += 999;
  write_one();
  write_one();
  EXPECT_EQ(left_by_a_crash(), first) << "a second after the last one";
  clock.ms += 1;
  write_one();
  write_one();
  EXPECT_GE(left_by_a_crash(), first + 2);
  recorder.finish();
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.ticks.size(), ticks);
  ASSERT_EQ(recording.known_to_mm.size(), ticks);
  for (std::uint64_t n = 0; n < ticks; ++n) {
    EXPECT_EQ(recording.ticks[n].index, n);
    EXPECT_EQ(recording.known_to_mm[n], static_cast<double>(n) + 0.5) << "each batch its own";
  }
}

/// By ticks, too: a session that does not wait for the clock may be over within a second.
TEST(RecorderClock, FlushesEvery2048TicksWhileTheClockStands) {
  for (const std::uint64_t batch : {700U, 2048U}) {
    const auto file = fresh_path("by_ticks.h5");
    TickRing ring(1U << 14U);
    HeldClock clock;
    Recorder recorder(ring, file, {}, {.now = clock.now()});
    std::uint64_t ticks = 0;
    const auto write = [&](std::uint64_t count) {
      push_ticks(ring, count);
      await_written(recorder, ticks += count);
    };
    for (const std::uint64_t flushed : {2048U, 4096U}) {
      for (std::uint64_t written = 0; written < 2048; written += batch) write(batch);
      write(1);  // what follows a batch is over when the next batch is written
      const auto left = fresh_path("left.h5");
      std::filesystem::copy_file(file.string() + ".partial", left);
      EXPECT_GE(read_recording(left).ticks.size(), flushed) << batch;
    }
    recorder.finish();
  }
}

/// A recording that fails ends with what was flushed last, to the byte, and says where that is.
TEST(RecorderClock, AFailureLeavesWhatWasFlushed) {
  const auto file = fresh_path("failed.h5"), left = fresh_path("left.h5");
  const std::filesystem::path partial = file.string() + ".partial";
  TickRing ring(1024);
  HeldClock clock;
  std::atomic<bool> fails{false};
  std::string flushed;
  {
    Recorder recorder(ring, file, {},
                      {.before_write =
                           [&] {
                             if (!fails) return;
                             flushed = io::internal::bytes_of(partial);
                             throw std::runtime_error("the disk is gone");
                           },
                       .now = clock.now()});
    std::uint64_t ticks = 0;
    const auto write_one = [&] {
      push_ticks(ring, 1);
      await_written(recorder, ++ticks);
    };
    write_one();
    clock.ms += 1000;
    write_one();
    write_one();  // a flush is over, after the first or the second
    write_one();
    fails = true;
    push_ticks(ring, 1);
    const RecorderStatus status = recorder.finish();
    EXPECT_TRUE(status.stopped);
    EXPECT_EQ(status.written, 4U);
    EXPECT_EQ(status.lost, 1U);
    const std::string why = status.why;
    EXPECT_NE(why.find("the disk is gone"), std::string::npos) << why;
    EXPECT_NE(why.find(partial.string()), std::string::npos) << why;
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_TRUE(io::internal::bytes_of(partial) == flushed);
  std::filesystem::copy_file(partial, left);
  const Recording recording = read_recording(left);
  EXPECT_FALSE(recording.complete);
  EXPECT_GE(recording.ticks.size(), 1U);
  EXPECT_LT(recording.ticks.size(), 4U) << "the last was not flushed";
}

/// While there is nothing to write it rests: five rounds of 20 ms can take longer, and never half of that.
TEST(RecorderClock, RestsWhileThereIsNothingToWrite) {
  using Clock = std::chrono::steady_clock;
  TickRing ring(64);
  std::promise<Clock::duration> rested;
  int looks = 0;
  Clock::time_point first;
  Recorder recorder(ring, fresh_path("idle.h5"), {}, {.now = [&] {
                      if (++looks == 2) first = Clock::now();  // once a round, and once before
                      if (looks == 7) rested.set_value(Clock::now() - first);
                      return Clock::time_point();
                    }});
  EXPECT_GE(rested.get_future().get(), std::chrono::milliseconds(50));
  recorder.finish();
}

/// Who is faster than the clock waits until half of the ring is free, and not where it is free already.
TEST(RecorderClock, WaitsForHalfOfTheRing) {
  TickRing ring(64);
  HeldDisk disk;
  disk.answers = false;
  Recorder recorder(ring, fresh_path("room.h5"), {}, {.before_write = disk.before_write()});
  push_ticks(ring, 31);
  EXPECT_EQ(recorder.backlog(), 31U);
  recorder.wait_for_room();  // returns, although the disk does not answer
  push_ticks(ring, 1);
  EXPECT_EQ(recorder.backlog(), 32U);
  Waiting waiting(recorder);
  disk.answers = true;
  EXPECT_LT(waiting.backlog_after(), 32U);
  EXPECT_EQ(recorder.finish().written, 32U);
}

/// A recording that has stopped keeps nobody waiting, says why, and counts all that came after as lost.
TEST(RecorderClock, WhatHasStoppedKeepsNobodyWaiting) {
  const auto file = fresh_path("stopped.h5");
  TickRing ring(64);
  HeldDisk disk;
  disk.answers = false;
  Recorder recorder(ring, file, {}, {.spare_bytes = std::uintmax_t{3} << 60U, .before_write = disk.before_write()});
  push_ticks(ring, 5);
  push_ticks(ring, 60);
  Waiting waiting(recorder);
  disk.answers = true;
  waiting.backlog_after();  // which comes back
  while (!recorder.status().stopped) std::this_thread::yield();
  push_ticks(ring, 50);
  recorder.wait_for_room();  // returns, although nothing is written any more
  const RecorderStatus status = recorder.finish();
  EXPECT_TRUE(status.stopped);
  EXPECT_EQ(static_cast<std::string>(status.why),
            "less than 3298534883328 MiB are left on the disk of " + file.string());
  EXPECT_EQ(status.written + status.lost, 115U);
  EXPECT_GE(status.lost, 50U);
  const Recording recording = read_recording(file);
  EXPECT_TRUE(recording.complete);
  EXPECT_EQ(recording.ticks.size(), status.written);
}

/// While the disk does not answer, the ring goes round: what is overwritten is a gap, with its first tick and length,
/// and the rest is written.
TEST(RecorderClock, WhatTheRingCouldNotHoldIsOneGap) {
  const auto file = fresh_path("gap.h5");
  TickRing ring(64);
  HeldDisk disk;
  disk.answers = false;
  Recorder recorder(ring, file, {}, {.before_write = disk.before_write()});
  push_ticks(ring, 64 + 37);
  disk.answers = true;
  // The first batch may have been asked for when fewer were there; all others are not yet lost.
  const RecorderStatus status = recorder.finish();
  EXPECT_EQ(status.lost, 37U);
  EXPECT_EQ(status.written, 64U);
  EXPECT_FALSE(status.stopped);
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.ticks.size(), 64U);
  EXPECT_EQ(recording.ticks.front().index, 37U);
  EXPECT_EQ(recording.ticks.back().index, 100U);
  std::uint64_t next = 0;
  for (const Gap& gap : recording.gaps) {
    EXPECT_EQ(gap.first_tick, next);
    next += gap.ticks;
  }
  EXPECT_EQ(next, 37U);
}

/// What is known of a tick is asked of its own scene, and only while it is not far behind: to the tick.
TEST(RecorderClock, ATickAsFarBehindAsAllowedIsStillAsked) {
  const auto file = fresh_path("behind.h5");
  TickRing ring(256);
  HeldDisk disk;
  disk.answers = false;
  Recorder recorder(ring, file, {}, {.most_behind = 10, .before_write = disk.before_write()});
  recorder.note(SceneRecord{.epoch = 0},
                [](const TickRecord& tick, auto) { return 1000.0 + static_cast<double>(tick.index); });
  push_ticks(ring, 30);
  disk.answers = true;
  recorder.finish();
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.known_to_mm.size(), 30U);
  for (std::size_t n = 0; n < 30; ++n) {
    if (n < 20) {
      EXPECT_TRUE(std::isnan(recording.known_to_mm[n])) << n;
    } else {
      EXPECT_EQ(recording.known_to_mm[n], 1000.0 + static_cast<double>(n)) << n;
    }
  }
}

/// More than a batch at once is written in several, in order.
TEST(RecorderClock, ABacklogOfManyBatchesIsWrittenInOrder) {
  const auto file = fresh_path("batches.h5");
  TickRing ring(1U << 14U);
  HeldDisk disk;
  disk.answers = false;
  std::atomic<int> batches{0};
  const auto hold = disk.before_write();
  Recorder recorder(ring, file, {}, {.before_write = [&] {
                      hold();
                      ++batches;
                    }});
  push_ticks(ring, 3 * 4096 + 5);
  disk.answers = true;
  EXPECT_EQ(recorder.finish().written, 3 * 4096U + 5);
  EXPECT_GE(batches.load(), 4) << "no more than 4096 in each";
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.ticks.size(), 3 * 4096U + 5);
  for (std::uint64_t n = 0; n < recording.ticks.size(); ++n) ASSERT_EQ(recording.ticks[n].index, n);
}

}  // namespace
}  // namespace palpate::plugin
