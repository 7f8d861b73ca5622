#pragma once

#include <cstdint>

#include "device/safety/guardian_beat.h"

namespace palpate::device {

/// Detects a session that is stopped while a force may be on the device (OnDevice::unknown counts as a force). It has
/// no clock: the caller polls it at even times.
class GuardianWatch {
 public:
  static constexpr int look_every_ms = 20;
  /// A session that has not counted for this long counts as stopped.
  static constexpr int stopped_after_ms = 200;
  static constexpr int looks_until_stopped = stopped_after_ms / look_every_ms;

  /// `beat`: the session's counter. Null if the session shares none; it then never counts as stopped.
  explicit GuardianWatch(const GuardianBeat* beat) : beat_(beat) {}
  /// Call it every look_every_ms. True from the poll at which the session has been stopped for looks_until_stopped
  /// polls, until it continues.
  bool stopped() {
    if (beat_ == nullptr) return false;
    const auto count = beat_->count.load(std::memory_order_relaxed);
    const bool still = count == count_ && beat_->on_device.load(std::memory_order_relaxed) != OnDevice::zero_taken;
    count_ = count;
    looks_ = still ? looks_ + 1 : 0;
    return looks_ >= looks_until_stopped;
  }
  /// Whether this is the first poll with stopped() true since the session last continued.
  bool stopped_just_now() const { return looks_ == looks_until_stopped; }

 private:
  const GuardianBeat* beat_;
  std::uint32_t count_ = 0;
  int looks_ = 0;
};

}  // namespace palpate::device
