#pragma once

/// The last second before a fault, and a little after it: what the safety filter got and gave.

#include <array>
#include <atomic>
#include <cstddef>
#include <vector>

#include "device/safety/safety_filter.h"

namespace palpate::device {

struct SafetyFrame {
  SafetyInput input;
  SafetyResult result;
};

/// A fixed ring written by the servo tick. It stops `frames_after_fault` frames after the first latched fault, and can
/// then be read from any thread.
class FaultLog {
 public:
  static constexpr std::size_t capacity = 1000;
  static constexpr std::size_t frames_after_fault = 100;

  /// In the tick: no allocation, lock or exception. Ignored once stopped.
  void record(const SafetyInput& input, const SafetyResult& result) noexcept;
  bool stopped() const noexcept { return stopped_.load(std::memory_order_acquire); }
  /// Oldest first. From the recording thread at any time; from another one only while stopped().
  std::vector<SafetyFrame> frames() const;
  /// Forgets the frames and records again. From the recording thread.
  void clear() noexcept;

 private:
  std::array<SafetyFrame, capacity> ring_;
  std::size_t count_ = 0;  // ever recorded
  std::size_t after_fault_ = 0;
  std::atomic<bool> stopped_{false};
};

}  // namespace palpate::device
