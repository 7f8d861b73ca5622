#include "plugin/recording/recorder.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

constexpr auto between_batches = std::chrono::milliseconds(20);
constexpr auto between_flushes = std::chrono::seconds(1);
constexpr std::uint64_t most_unflushed = 2048;  // ticks
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t most_of_batch = 4096;  // ticks: bounds memory, and the time until an end is noticed

}  // namespace

Recorder::Recorder(const TickRing& ring, std::filesystem::path file, const RecordingHeader& header,
                   RecorderOptions options)
    : ring_(ring),
      options_(std::move(options)),
      file_(std::move(file)),
      next_(options_.first_tick.value_or(ring.written())),
      writer_(file_, header),
      thread_([this] { run(); }) {}

Recorder::~Recorder() {
  if (thread_.joinable()) {
    finish();
  }
}

void Recorder::note(const SceneRecord& scene, KnownTo known_to) {
  const std::lock_guard lock(mutex_);
  events_.emplace_back([this, scene, known_to = std::move(known_to)](RecordingWriter& writer) {
    writer.append(scene);
    known_to_[scene.epoch] = known_to;
  });
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
  progress_.notify_all();  // or else it rests to the end of its 20 ms
  if (thread_.joinable()) {
    thread_.join();
    const std::lock_guard lock(mutex_);
    status_.lost += end_ - next();  // of a recording that stopped early: all that came after
  }
  return status();
}

void Recorder::run() {
  auto flushed = options_.now();
  std::uint64_t flushed_tick = next();
  bool ending = false;
  try {
    // Once more after the end was asked for: until nothing is left.
    while (write_batch() || !ending) {
      if (!has_room()) {
        writer_.finish();
        stop(say("less-than-mib-are-left-on", options_.spare_bytes >> 20U, file_.string()));
        return;
      }
      // By ticks, too: a session that does not wait for the clock may be over within a second.
      if (options_.now() - flushed >= between_flushes || next() - flushed_tick >= most_unflushed) {
        writer_.flush();
        flushed = options_.now();
        flushed_tick = next();
      }
      std::unique_lock lock(mutex_);
      progress_.notify_all();
      ending =
          ending_ || (backlog() < most_of_batch && progress_.wait_for(lock, between_batches, [&] { return ending_; }));
    }
    writer_.finish();
  } catch (const std::exception& error) {
    stop(say("what-was-written-before", error.what(), writer_.partial().string()));
  }
}

bool Recorder::has_room() const {
  std::error_code unknown;
  const auto space = std::filesystem::space(writer_.partial(), unknown);
  return unknown || space.available >= options_.spare_bytes;
}

/// False if there was nothing to write.
bool Recorder::write_batch() {
  const std::uint64_t written = ring_.written();  // first: the scenes of these ticks are among the events
  std::vector<std::function<void(RecordingWriter&)>> events;
  std::uint64_t end = 0;
  {
    const std::lock_guard lock(mutex_);
    events.swap(events_);
    end = end_;
  }
  const std::uint64_t begin = next();
  const std::uint64_t until = std::min({written, begin + most_of_batch, end});
  if (events.empty() && until == begin) {
    return false;
  }
  if (options_.before_write) {
    options_.before_write();
  }
  for (const auto& event : events) {
    event(writer_);
  }
  write_ticks(until);
  return true;
}

void Recorder::write_ticks(std::uint64_t until) {
  ticks_.clear();
  shares_.clear();
  known_to_mm_.clear();
  Gap gap;
  TickRecord tick;
  std::uint64_t n = next();
  // A lost tick of the ring has no number to tell: its place in the file does.
  const auto lose = [&](std::uint64_t ticks) {
    if (gap.ticks == 0) {
      gap.first_tick = n;
    }
    gap.ticks += ticks;
  };
  if (ring_.oldest() > n) {
    lose(std::min(ring_.oldest(), until) - n);
    n += gap.ticks;
  }
  for (; n < until; ++n) {
    const std::size_t first_share = shares_.size();
    if (ring_.read(n, tick, &shares_)) {
      ticks_.push_back(tick);
      const bool is_behind = ring_.written() - n > options_.most_behind;
      known_to_mm_.push_back(is_behind ? not_known : known_to(tick, std::span(shares_).subspan(first_share)));
    } else {
      lose(1);
    }
  }
  writer_.append(ticks_, shares_, known_to_mm_);
  // The scans of scenes that are over are not to be held.
  if (!ticks_.empty()) known_to_.erase(known_to_.begin(), known_to_.lower_bound(ticks_.back().scene_epoch));
  if (gap.ticks > 0) {
    writer_.append(gap);
  }
  next_.store(until, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  status_.written += ticks_.size();
  status_.lost += gap.ticks;
}

double Recorder::known_to(const TickRecord& tick, std::span<const PrimitiveRecord> shares) const {
  const auto scene = known_to_.find(tick.scene_epoch);
  return scene == known_to_.end() || !scene->second ? not_known : scene->second(tick, shares);
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
