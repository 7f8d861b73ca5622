#pragma once

/// The servo loop: a thread that ticks a session at absolute deadlines.

#include <atomic>
#include <cstdint>
#include <thread>

#include "device/link/realtime.h"
#include "plugin/session/session.h"

namespace palpate::plugin {

class Servo {
 public:
  /// Starts to tick, with SCHED_FIFO and locked memory where the system allows it (realtime() says). The session has to
  /// outlive the servo; while the servo runs only the controlling thread may call the session. Throws
  /// std::invalid_argument where the rate is out of range.
  explicit Servo(Session& session, double rate_hz = 1000);
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;
  /// Stops.
  ~Servo();

  /// Says that the controlling thread is alive. Call it at least every half second, or the force is ramped to zero
  /// (device::SafetyLimits::heartbeat_time).
  void heartbeat() noexcept { heartbeats_.fetch_add(1, std::memory_order_relaxed); }
  /// Returns when the last tick has ended; the thread that called it may tick the session from then on.
  void stop() noexcept;

  /// What the system allowed.
  const device::RealtimeStatus& realtime() const noexcept { return realtime_; }
  std::uint64_t ticks() const noexcept { return ticks_.load(std::memory_order_relaxed); }
  /// Deadlines that went by without a tick; each is in the TickRecord::missed of the tick that came after.
  std::uint64_t missed() const noexcept { return missed_.load(std::memory_order_relaxed); }

 private:
  void run(device::Metronome metronome, double period_s) noexcept;

  Session& session_;
  device::RealtimeStatus realtime_;
  std::atomic<std::uint64_t> heartbeats_{0}, ticks_{0}, missed_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::plugin
