#pragma once

#include <chrono>
#include <thread>

#include "device/link/realtime.h"

namespace palpate::device {

inline void sleep_seconds(double seconds) noexcept {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// The clock of a driver that uses a maker's library: the system's, or that of a fake in the same process.
struct DriverClock {
  double (*now)() noexcept = monotonic_time;  ///< s, never decreasing
  void (*sleep)(double seconds) noexcept = sleep_seconds;
};

}  // namespace palpate::device
