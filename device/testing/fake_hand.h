#pragma once

/// The simulated hand on a fake device, computed as for the simulated stylus and stepped by the clock of the fake's
/// mount.

#include <span>
#include <vector>

#include "device/simulated/hand_path.h"
#include "device/simulated/simulated_hand.h"

namespace palpate::device {

class FakeHand {
 public:
  FakeHand(const ArmModel& arm, const HandModel& hand, std::span<const Waypoint> path);

  /// Advances to `now` (s since the first call) under a constant force (N).
  void advance(double now, const Vec3& force) noexcept;
  /// Sets the hand's velocity (m/s) at its present position.
  void fling(const Vec3& velocity) noexcept {
    body_.velocity = flung_ = velocity;
    flung_from_ = body_.position;
    flung_at_ = time_;
    steps_to_target_ = 0;
  }
  const BodyState& body() const noexcept { return body_; }
  double time() const noexcept { return time_; }
  std::uint32_t buttons() const noexcept { return buttons_; }

 private:
  ArmModel arm_;
  HandModel hand_;
  Tremor tremor_;
  std::vector<Waypoint> path_;
  BodyState body_;
  Vec3 target_{0};
  Vec3 target_velocity_{0};
  int steps_to_target_ = 0;
  Vec3 flung_{0};
  Vec3 flung_from_{0};
  double flung_at_ = 0;
  std::uint32_t buttons_ = 0;
  double start_ = 0;
  double time_ = 0;
  bool started_ = false;
};

}  // namespace palpate::device
