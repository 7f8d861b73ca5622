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
  if (!started_) {
    started_ = true;
    start_ = now;
  }
  while (time_ + step <= now - start_) {
    time_ += step;
    const Waypoint aim = point_on(path_, PathInterpolation::minimum_jerk, time_);
    const Vec3 thrown = flung_from_ + (time_ - flung_at_) * flung_;
    const Vec3 target = flung_ != Vec3(0) ? thrown : aim.position + tremor_(time_);
    buttons_ = aim.buttons;
    step_body(arm_, hand_, force, target, (target - target_) / step, step, body_);
    target_ = target;
  }
}

}  // namespace palpate::device
