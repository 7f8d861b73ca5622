#pragma once

/// The memory that a session and its guardian share. Each counts up a counter that the other reads. The guardian also
/// writes a proof.

#include <atomic>
#include <cstdint>

#include "device/safety/on_device.h"

namespace palpate::device {

/// What the guardian can do with its device.
enum class GuardianReach : std::uint32_t {
  untold,       ///< not known: it has not checked yet
  none,         ///< it finds no device, no rights to it, or no maker's library
  looks_on,     ///< it can only see whether the force is gone
  once_free,    ///< it takes the force away once the session has released the device, not while the session is only
                ///< stopped
  at_any_time,  ///< it can also take it from a session that is stopped
};

/// Neither side waits for the other: every member is atomic, or written before the guardian starts.
struct GuardianBeat {
  // The session's.
  std::atomic<std::uint32_t> count{0};                    ///< exchanges with the device
  std::atomic<OnDevice> on_device{OnDevice::zero_taken};  ///< at the last exchange; initially nothing was given
  std::uint32_t challenge = 0;                            ///< drawn for this guardian
  // The guardian's.
  std::atomic<std::uint32_t> proof{0};  ///< proof_for(challenge): a palpate-guardian writes this memory
  std::atomic<GuardianReach> reach{GuardianReach::untold};
  std::atomic<std::uint32_t> zero_within_ms{0};  ///< ms from its first action until a zero is taken
  std::atomic<std::uint32_t> lives{0};           ///< its polls: 10 a second or more
  std::atomic<bool> sleep_is_near{false};        ///< the machine is about to sleep, and waits for a zero
};

/// Never 0. It differs for every version of GuardianBeat, so that a guardian of another version fails the proof.
constexpr std::uint32_t proof_for(std::uint32_t challenge) {
  constexpr std::uint32_t version = 2, odd = 0x9e3779b1U;
  return ((challenge ^ version) * odd) | 1U;
}

/// For the session: detects a guardian that ended or does not respond.
class MissedGuardian {
 public:
  void start(std::uint32_t lives, double now) noexcept {
    lives_ = lives;
    time_ = now;
  }
  /// s since its counter last changed.
  double silent_for(std::uint32_t lives, double now) noexcept {
    if (lives != lives_) start(lives, now);
    return now - time_;
  }

 private:
  std::uint32_t lives_ = 0;
  double time_ = 0;
};

}  // namespace palpate::device
