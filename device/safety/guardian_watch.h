#pragma once

#include <cstdint>

#include "device/safety/guardian_beat.h"

namespace palpate::device {

/// Notices a session that stands still while a force may lie on the device (OnDevice::unknown counts as a force). A
/// function of what it sees at its looks: who looks keeps the time.
class GuardianWatch {
 public:
  static constexpr int look_every_ms = 20;
  /// A device takes a force that is older for no force of ours.
  static constexpr int stopped_after_ms = 200;
  static constexpr int looks_until_stopped = stopped_after_ms / look_every_ms;

  /// `beat`: what the session shares; null where it shares nothing, which never counts as stopped.
  explicit GuardianWatch(const GuardianBeat* beat) : beat_(beat) {}
  /// To be called every look_every_ms. True from the look on at which the session has stood still for
  /// looks_until_stopped looks, until it goes on.
  bool stopped() {
    if (beat_ == nullptr) return false;
    const auto count = beat_->count.load(std::memory_order_relaxed);
    const bool still = count == count_ && beat_->on_device.load(std::memory_order_relaxed) != OnDevice::zero_taken;
    count_ = count;
    looks_ = still ? looks_ + 1 : 0;
    return looks_ >= looks_until_stopped;
  }
  /// The first time since the session went on.
  bool stopped_just_now() const { return looks_ == looks_until_stopped; }

 private:
  const GuardianBeat* beat_;
  std::uint32_t count_ = 0;
  int looks_ = 0;
};

}  // namespace palpate::device
