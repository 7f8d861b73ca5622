#include "device/testing/fake_hand.h"

namespace palpate::device {

FakeHand::FakeHand(const ArmModel& arm, const HandModel& hand, std::span<const Waypoint> path)
    : arm_(arm), hand_(hand), tremor_(hand), path_(path.begin(), path.end()) {
  check_path(path);
  target_ = path_.front().position + tremor_(0);
  body_.position = path_.front().position;
}

void FakeHand::advance(double now, const Vec3& force) noexcept {
  constexpr double step = 50e-6;
  constexpr int steps =
      20;  // between two places of the target: a path and a tremor of 12 Hz are straight in a millisecond
  if (!started_) {
    started_ = true;
    start_ = now;
  }
  while (time_ + step <= now - start_) {
    if (steps_to_target_ == 0) {
      steps_to_target_ = steps;
      const double there = time_ + steps * step;
      const Waypoint aim = point_on(path_, PathInterpolation::minimum_jerk, there);
      const Vec3 thrown = flung_from_ + (there - flung_at_) * flung_;
      const Vec3 target = flung_ != Vec3(0) ? thrown : aim.position + tremor_(there);
      buttons_ = aim.buttons;
      target_velocity_ = (target - target_) / (steps * step);
    }
    --steps_to_target_;
    time_ += step;
    target_ += step * target_velocity_;
    step_body(arm_, hand_, force, target_, target_velocity_, step, body_);
  }
}

}  // namespace palpate::device
