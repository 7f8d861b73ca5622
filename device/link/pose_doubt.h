#pragma once

/// Decides when impossible poses are a fault. A single one is a garbled packet, or a hand at the edge of the reach: the
/// driver then keeps the last pose and marks it doubtful. It is a fault only if that lasts.

#include <algorithm>

namespace palpate::device {

class PoseDoubt {
 public:
  static constexpr double patience = 0.080;  ///< s

  /// `recovery`: s of doubt that a second of good poses removes.
  explicit PoseDoubt(double recovery) : recovery_(recovery) {}

  /// Call it for an impossible pose, at a time in s. Returns whether the doubt has lasted longer than `patience`.
  bool lasts(double now) noexcept {
    if (time_ > 0) doubt_ += std::max(0.0, now - time_);
    time_ = now;
    return doubt_ > patience;
  }
  /// Call it for a possible pose, at a time in s.
  void ends(double now) noexcept {
    doubt_ = std::max(0.0, doubt_ - recovery_ * (now - time_));
    time_ = now;
  }
  void forget() noexcept { doubt_ = time_ = 0; }

 private:
  double recovery_;
  double doubt_ = 0;  // s
  double time_ = 0;   // s: of the last pose
};

}  // namespace palpate::device
