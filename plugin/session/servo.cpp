#include "plugin/session/servo.h"

#include <algorithm>
#include <future>
#include <memory>
#include <utility>

namespace palpate::plugin {

Servo::Servo(Session& session, double rate_hz)
    : Servo(session, std::make_unique<RealClock>(1 / rate_hz), 1 / rate_hz) {}

Servo::Servo(Session& session, std::unique_ptr<ServoClock> clock, double period_s)
    : session_(session), clock_(std::move(clock)), period_s_(period_s) {
  std::promise<device::RealtimeStatus> started;
  std::future<device::RealtimeStatus> status = started.get_future();
  thread_ = std::thread([this, &started] {
    const device::RealtimeStatus granted = device::become_realtime();
    started.set_value(granted);
    run();
  });
  realtime_ = status.get();
}

Servo::~Servo() {
  stop();
}

void Servo::stop() noexcept {
  if (thread_.joinable()) {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
}

void Servo::run() noexcept {
  std::uint64_t heartbeats = 0, ticks = 0, missed = 0;
  Beat beat;
  while (!stop_.load(std::memory_order_relaxed)) {
    const ServoClock::Deadline deadline = clock_->wait(heartbeats_.load(std::memory_order_relaxed));
    if (!deadline.due) continue;
    missed += deadline.skipped;
    beat.missed = static_cast<std::uint32_t>(deadline.skipped);
    beat.late_ns = static_cast<std::uint32_t>(std::clamp(deadline.late_s * 1e9, 0.0, 4e9));
    // Counted, not read from a clock: a replay gives the filter the same times.
    beat.time_s = static_cast<double>(ticks + missed) * period_s_;
    if (heartbeats_.load(std::memory_order_relaxed) != heartbeats || ticks == 0) {
      heartbeats = heartbeats_.load(std::memory_order_relaxed);
      beat.heartbeat_s = beat.time_s;
    }
    session_.tick(beat);
    ticks_.store(++ticks, std::memory_order_relaxed);
    missed_.store(missed, std::memory_order_relaxed);
  }
}

}  // namespace palpate::plugin
