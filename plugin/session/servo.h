#pragma once

/// The servo loop: a thread that ticks a session at absolute deadlines.

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "device/link/realtime.h"
#include "plugin/session/servo_clock.h"
#include "plugin/session/session.h"

namespace palpate::plugin {

class Servo {
 public:
  /// Starts to tick, with SCHED_FIFO and locked memory if the system allows it (realtime() tells). The session must
  /// outlive the servo. While the servo runs, only the controlling thread may call the session. Throws
  /// std::invalid_argument if the rate is out of range.
  explicit Servo(Session& session, double rate_hz = 1000);
  /// The same with another clock, whose deadlines are period_s apart. For tests only.
  Servo(Session& session, std::unique_ptr<ServoClock> clock, double period_s);
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;
  /// Stops.
  ~Servo();

  /// Says that the controlling thread is alive. Call it at least every half second; after
  /// device::SafetyLimits::heartbeat_time without a call the force is ramped to zero.
  void heartbeat() noexcept { heartbeats_.fetch_add(1, std::memory_order_relaxed); }
  /// Returns when the last tick has ended. After that the calling thread may tick the session.
  void stop() noexcept;

  /// The real-time rights that the system granted.
  const device::RealtimeStatus& realtime() const noexcept { return realtime_; }
  std::uint64_t ticks() const noexcept { return ticks_.load(std::memory_order_relaxed); }
  /// Deadlines that passed without a tick. TickRecord::missed of the next tick counts them too.
  std::uint64_t missed() const noexcept { return missed_.load(std::memory_order_relaxed); }

 private:
  void run() noexcept;

  Session& session_;
  std::unique_ptr<ServoClock> clock_;  // never null
  double period_s_;
  device::RealtimeStatus realtime_;
  std::atomic<std::uint64_t> heartbeats_{0}, ticks_{0}, missed_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::plugin
