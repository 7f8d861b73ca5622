#pragma once

/// The memory that a session and its guardian share: each counts for the other, and the guardian proves what it is.

#include <atomic>
#include <cstdint>

#include "device/safety/on_device.h"

namespace palpate::device {

/// What a guardian can do for its device.
enum class GuardianReach : std::uint32_t {
  untold,       ///< it has not looked yet
  none,         ///< it finds no device, no rights to it, or no maker's library
  looks_on,     ///< it can only see whether the force is gone
  once_free,    ///< takes the force away once the session has let go of the device: not while that is only stopped
  at_any_time,  ///< also from a session that stands still
};

/// Neither side waits for the other: all of it is atomic, or written before the guardian starts.
struct GuardianBeat {
  // The session's.
  std::atomic<std::uint32_t> count{0};                    ///< exchanges with the device
  std::atomic<OnDevice> on_device{OnDevice::zero_taken};  ///< at the last of them; before the first: nothing was given
  std::uint32_t challenge = 0;                            ///< drawn for this guardian
  // The guardian's.
  std::atomic<std::uint32_t> proof{0};  ///< proof_for(challenge): this memory is written by a palpate-guardian
  std::atomic<GuardianReach> reach{GuardianReach::untold};
  std::atomic<std::uint32_t> zero_within_ms{0};  ///< ms that it needs for a zero once it acts
  std::atomic<std::uint32_t> lives{0};           ///< its looks: 10 a second or more
  std::atomic<bool> sleep_is_near{false};        ///< the machine is about to sleep, and waits for a zero
};

/// Never 0. Another value for every version of GuardianBeat: a guardian of another version proves nothing.
constexpr std::uint32_t proof_for(std::uint32_t challenge) {
  constexpr std::uint32_t version = 2, odd = 0x9e3779b1U;
  return ((challenge ^ version) * odd) | 1U;
}

/// The session's side: a guardian that is dead or stands still.
class MissedGuardian {
 public:
  void start(std::uint32_t lives, double now) noexcept {
    lives_ = lives;
    time_ = now;
  }
  /// s since it was last seen to live.
  double silent_for(std::uint32_t lives, double now) noexcept {
    if (lives != lives_) start(lives, now);
    return now - time_;
  }

 private:
  std::uint32_t lives_ = 0;
  double time_ = 0;
};

}  // namespace palpate::device
