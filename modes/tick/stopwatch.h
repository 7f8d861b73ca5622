#pragma once

/// The time that each part of a tick takes, measured so cheaply that every tick is measured. No force depends on it, so
/// that a replay gives the same forces.

#include <cstdint>

#if !defined(__x86_64__)
#include <chrono>
#endif

namespace palpate::modes {

/// A count that grows evenly with time, in a unit of its own: see counts_per_ns().
inline std::uint64_t clock_count() noexcept {
#if defined(__x86_64__)
  // The processor's time stamp: a quarter of the cost of std::chrono's clocks, which would be a tenth of a tick.
  return __builtin_ia32_rdtsc();
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1));
#endif
}

/// Measured against the system's clock by the first call, which takes some milliseconds: call it before the first tick.
double counts_per_ns();

/// Counts for each part of a step, summed over its sub-steps.
struct StepTimes {
  std::uint64_t map = 0;     ///< between the device's frame and the patient
  std::uint64_t sample = 0;  ///< of the fields
  std::uint64_t modes = 0;   ///< placing primitives
  std::uint64_t solve = 0;   ///< the balance
};

/// Divides the elapsed time among the parts of a step.
class Stopwatch {
 public:
  void start() noexcept { last_ = clock_count(); }
  /// Adds the time since start() or the last lap.
  void lap(std::uint64_t& part) noexcept {
    const std::uint64_t now = clock_count();
    part += now - last_;
    last_ = now;
  }

 private:
  std::uint64_t last_ = 0;
};

}  // namespace palpate::modes
