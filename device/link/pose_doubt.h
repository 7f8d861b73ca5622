#pragma once

/// One pose that cannot be is a garbled packet, or a hand at the edge of the reach: the last one is held and nothing is
/// pushed. Only where that lasts is it a fault.

#include <algorithm>

namespace palpate::device {

class PoseDoubt {
 public:
  static constexpr double patience = 0.080;  ///< s

  /// `recovery`: s of doubt that a second of good poses takes away.
  explicit PoseDoubt(double recovery) : recovery_(recovery) {}

  /// Of a pose that cannot be, at a time in s; whether the doubt has lasted for longer than the patience.
  bool lasts(double now) noexcept {
    if (time_ > 0) doubt_ += std::max(0.0, now - time_);
    doubtful_ = true;
    time_ = now;
    return doubt_ > patience;
  }
  /// Of one that can be.
  void ends(double now) noexcept {
    doubt_ = std::max(0.0, doubt_ - recovery_ * (now - time_));
    doubtful_ = false;
    time_ = now;
  }
  void forget() noexcept {
    doubt_ = time_ = 0;
    doubtful_ = false;
  }
  bool is_doubtful() const noexcept { return doubtful_; }

 private:
  double recovery_;
  double doubt_ = 0;  // s
  double time_ = 0;   // s: of the last pose
  bool doubtful_ = false;
};

}  // namespace palpate::device
