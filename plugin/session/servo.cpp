#include "plugin/session/servo.h"

#include <algorithm>
#include <future>

namespace palpate::plugin {

Servo::Servo(Session& session, double rate_hz) : session_(session) {
  const double period_s = 1 / rate_hz;
  device::Metronome checked(period_s);
  std::promise<device::RealtimeStatus> started;
  std::future<device::RealtimeStatus> status = started.get_future();
  thread_ = std::thread([this, period_s, &started] {
    const device::RealtimeStatus granted = device::become_realtime();
    started.set_value(granted);
    run(device::Metronome(period_s), period_s);
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

void Servo::run(device::Metronome metronome, double period_s) noexcept {
  std::uint64_t heartbeats = 0;
  Beat beat;
  while (!stop_.load(std::memory_order_relaxed)) {
    const std::uint64_t missed = metronome.missed();
    const double late_s = metronome.wait();
    beat.missed = static_cast<std::uint32_t>(metronome.missed() - missed);
    beat.late_ns = static_cast<std::uint32_t>(std::clamp(late_s * 1e9, 0.0, 4e9));
    // Counted, not read from a clock: a replay gives the filter the same times.
    beat.time_s = static_cast<double>(metronome.ticks() + metronome.missed() - 1) * period_s;
    if (heartbeats_.load(std::memory_order_relaxed) != heartbeats || metronome.ticks() == 1) {
      heartbeats = heartbeats_.load(std::memory_order_relaxed);
      beat.heartbeat_s = beat.time_s;
    }
    session_.tick(beat);
    ticks_.store(metronome.ticks(), std::memory_order_relaxed);
    missed_.store(metronome.missed(), std::memory_order_relaxed);
  }
}

}  // namespace palpate::plugin
