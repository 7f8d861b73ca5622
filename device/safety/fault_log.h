#pragma once

/// The inputs and results of the safety filter in the last second before a fault, and a little after it.

#include <array>
#include <atomic>
#include <cstddef>
#include <vector>

#include "device/safety/safety_filter.h"

namespace palpate::device {

struct SafetyTick {
  SafetyInput input;
  SafetyResult result;
};

/// A ring of fixed size, written in the servo tick. It stops `ticks_after_fault` ticks after a fault was latched, or
/// earlier if the fault is cleared. Any one thread can then read it until that thread clears it.
class FaultLog {
 public:
  static constexpr std::size_t capacity = 1000;
  static constexpr std::size_t ticks_after_fault = 100;

  /// In the tick: no allocation, lock or exception. Ignored once stopped.
  void record(const SafetyInput& input, const SafetyResult& result) noexcept;
  bool stopped() const noexcept { return stopped_.load(std::memory_order_acquire); }
  /// Oldest first. From the recording thread at any time; from another one only while stopped().
  std::vector<SafetyTick> ticks() const;
  /// Forgets the ticks and records again; a fault that is still latched does not start another record. From the
  /// recording thread, or while stopped() from the one that reads.
  void clear() noexcept;

 private:
  std::array<SafetyTick, capacity> ring_;
  std::size_t count_ = 0;  // ever recorded
  std::size_t after_fault_ = 0;
  bool was_clear_ = true;  // since there was no fault
  std::atomic<bool> stopped_{false};
};

}  // namespace palpate::device
