#pragma once

/// The clock that tells a servo when to tick.

#include <cstdint>
#include <utility>

#include "device/link/realtime.h"

namespace palpate::plugin {

class ServoClock {
 public:
  /// The result of wait().
  struct Deadline {
    bool due = true;            ///< false: no deadline yet; ask again
    double late_s = 0;          ///< how long after the deadline wait() returned
    std::uint64_t skipped = 0;  ///< deadlines before this one that passed without a tick
  };

  virtual ~ServoClock() = default;
  /// Waits for the next deadline. Only the servo's thread calls this. `heartbeats`: how many the controlling thread has
  /// given so far.
  virtual Deadline wait(std::uint64_t heartbeats) noexcept = 0;
};

/// The computer's clock, with deadlines at an even rate. A late tick does not delay the deadlines after it.
class RealClock : public ServoClock {
 public:
  /// Throws std::invalid_argument for a period (s) outside the servo's range.
  explicit RealClock(double period_s) : period_s_(period_s), metronome_(period_s) {}

  Deadline wait(std::uint64_t) noexcept override {
    if (!std::exchange(runs_, true)) metronome_ = device::Metronome(period_s_);  // starts in the servo's thread
    const std::uint64_t missed = metronome_.missed();
    const double late_s = metronome_.wait();
    return {.late_s = late_s, .skipped = metronome_.missed() - missed};
  }

 private:
  double period_s_;
  device::Metronome metronome_;
  bool runs_ = false;
};

}  // namespace palpate::plugin
