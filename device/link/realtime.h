#pragma once

/// Real-time scheduling for a servo thread, and how well its deadlines were met.

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "solver/text/message.h"

namespace palpate::device {

struct RealtimeStatus {
  bool scheduled = false;      ///< SCHED_FIFO was granted to this thread
  bool memory_locked = false;  ///< no page of the process will be fetched from disk in a tick
  Text advice;                 ///< empty, or what the system refused and what to do about it
};

/// SCHED_FIFO for the calling thread. If the system does not allow it, returns false and changes nothing.
bool make_thread_realtime(int priority) noexcept;

/// SCHED_FIFO for the calling thread and locked memory for the process. Never throws; the result says what was refused.
RealtimeStatus become_realtime(int priority = 50);
/// What was refused, of the two, and what to do about it; for where not both were granted.
Text realtime_advice(bool scheduled, bool memory_locked);

/// Absolute deadlines at an even rate, so that delays do not add up. All times are of CLOCK_MONOTONIC.
class Metronome {
 public:
  /// The first deadline is one period from now. The period (s) must lie between 10 us and 1 s; throws
  /// std::invalid_argument otherwise.
  explicit Metronome(double period);

  /// Sleeps until the next deadline and returns how late it woke, s. Deadlines that have passed by more than a period
  /// are skipped and counted.
  double wait() noexcept;

  std::uint64_t ticks() const noexcept { return ticks_; }    ///< deadlines met or late by less than a period
  std::uint64_t missed() const noexcept { return missed_; }  ///< deadlines that passed without a tick

 private:
  std::int64_t period_;    // ns
  std::int64_t deadline_;  // ns
  std::uint64_t ticks_ = 0;
  std::uint64_t missed_ = 0;
};

/// s of CLOCK_MONOTONIC.
double monotonic_time() noexcept;

/// s that the machine has slept since it was started. CLOCK_MONOTONIC stands still then, so no age shows it.
double time_asleep() noexcept;
/// The same, computed from the times (ns) that `read_ns` returns for CLOCK_BOOTTIME and CLOCK_MONOTONIC.
double time_asleep_by(std::int64_t (*read_ns)(clockid_t)) noexcept;

}  // namespace palpate::device
