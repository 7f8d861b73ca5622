#include "plugin/recording/recorder.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto between_batches = std::chrono::milliseconds(20);
constexpr auto between_flushes = std::chrono::seconds(1);
constexpr std::uint64_t most_of_batch = 4096;  // frames: bounds memory, and the time until an end is noticed

}  // namespace

Recorder::Recorder(const TickRing& ring, std::filesystem::path file, const RecordingHeader& header,
                   RecorderOptions options)
    : ring_(ring),
      options_(std::move(options)),
      file_(std::move(file)),
      next_(options_.first_frame.value_or(ring.written())),
      writer_(file_, header),
      thread_([this] { run(); }) {}

Recorder::~Recorder() {
  if (thread_.joinable()) {
    finish();
  }
}

void Recorder::note(const SceneRecord& scene) {
  const std::lock_guard lock(mutex_);
  events_.emplace_back([scene](RecordingWriter& writer) { writer.append(scene); });
}

void Recorder::note(const StylusRecord& stylus) {
  const std::lock_guard lock(mutex_);
  events_.emplace_back([stylus](RecordingWriter& writer) { writer.append(stylus); });
}

std::uint64_t Recorder::backlog() const noexcept {
  return ring_.written() - next();
}

void Recorder::wait_for_room() {
  if (backlog() < ring_.capacity() / 2) {
    return;
  }
  std::unique_lock lock(mutex_);
  progress_.wait(lock, [&] { return status_.stopped || backlog() < ring_.capacity() / 2; });
}

RecorderStatus Recorder::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

RecorderStatus Recorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    end_ = ring_.written();
  }
  progress_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
    const std::lock_guard lock(mutex_);
    status_.lost += end_ - next();  // of a recording that stopped early: all that came after
  }
  return status();
}

void Recorder::run() {
  Clock::time_point flushed = Clock::now();
  bool ending = false;
  try {
    // Once more after the end was asked for: until nothing is left.
    while (write_batch() || !ending) {
      if (!has_room()) {
        writer_.finish();
        stop(say("less-than-mib-are-left-on", options_.spare_bytes >> 20U, file_.string()));
        return;
      }
      if (Clock::now() - flushed >= between_flushes) {
        writer_.flush();
        flushed = Clock::now();
      }
      std::unique_lock lock(mutex_);
      progress_.notify_all();
      ending =
          ending_ || (backlog() < most_of_batch && progress_.wait_for(lock, between_batches, [&] { return ending_; }));
    }
    writer_.finish();
  } catch (const std::exception& error) {
    writer_.abandon();
    stop(say("what-was-written-before", error.what(), writer_.partial().string()));
  }
}

bool Recorder::has_room() const {
  std::error_code unknown;
  const auto space = std::filesystem::space(writer_.partial(), unknown);
  return unknown || space.available >= options_.spare_bytes;
}

/// False where there was nothing to write.
bool Recorder::write_batch() {
  std::vector<std::function<void(RecordingWriter&)>> events;
  std::uint64_t end = 0;
  {
    const std::lock_guard lock(mutex_);
    events.swap(events_);
    end = end_;
  }
  const std::uint64_t begin = next();
  const std::uint64_t until = std::min({ring_.written(), begin + most_of_batch, end});
  if (events.empty() && until == begin) {
    return false;
  }
  if (options_.before_write) {
    options_.before_write();
  }
  for (const auto& event : events) {
    event(writer_);
  }
  write_frames(until);
  return true;
}

void Recorder::write_frames(std::uint64_t until) {
  frames_.clear();
  shares_.clear();
  Gap gap;
  TickRecord frame;
  std::uint64_t n = next();
  // A lost frame of the ring has no number to tell: its place in the file does.
  const auto lose = [&](std::uint64_t frames) {
    if (gap.frames == 0) {
      gap.first_frame = n;
    }
    gap.frames += frames;
  };
  if (ring_.oldest() > n) {
    lose(std::min(ring_.oldest(), until) - n);
    n += gap.frames;
  }
  for (; n < until; ++n) {
    if (ring_.read(n, frame, &shares_)) {
      frames_.push_back(frame);
    } else {
      lose(1);
    }
  }
  writer_.append(frames_, shares_);
  if (gap.frames > 0) {
    writer_.append(gap);
  }
  next_.store(until, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  status_.written += frames_.size();
  status_.lost += gap.frames;
}

void Recorder::stop(const Text& why) {
  {
    const std::lock_guard lock(mutex_);
    status_.stopped = true;
    status_.why = why;
  }
  progress_.notify_all();
}

}  // namespace palpate::plugin
