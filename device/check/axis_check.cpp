#include "device/check/axis_check.h"

#include <algorithm>
#include <cmath>

namespace palpate::device {

namespace {

constexpr std::array<const char*, 3> directions{"to the right", "up", "towards you"};

/// Ticks at 1 kHz: everything that reaches the stylus went through the filter.
class Pusher {
 public:
  Pusher(Stylus& stylus, const std::function<double()>& next, double force) : stylus_(stylus), next_(next) {
    limits_.force = force;
    limits_.device_force = stylus.specification().maximum_force;
    limits_.ramp_time = 0.3;
  }
  /// Returns where the stylus is after so many s.
  Vec3 run(const Vec3& force, double seconds) {
    SafetyInput input;
    double now = next_();
    const double end = now + seconds;
    while (now < end) {
      input.time = input.force_time = input.heartbeat_time = now;
      input.reading = stylus_.read();
      input.device = stylus_.state();
      input.force = force;
      result = filter_force(limits_, input, state_);
      stylus_.write_force(result.force);
      now = next_();
    }
    return input.reading.position;
  }
  Vec3 push(const Vec3& force, double seconds) {
    arm(state_);
    return run(force, seconds);
  }
  void release() {
    disarm(state_);
    run(Vec3(0), 0.1);
  }

  SafetyResult result;

 private:
  Stylus& stylus_;
  const std::function<double()>& next_;
  SafetyLimits limits_;
  SafetyState state_;
};

bool can_push(State state) {
  return state == State::idle || state == State::ramping || state == State::active;
}

int sign_of(Felt felt) {
  return felt == Felt::opposite ? -1 : 1;
}

}  // namespace

const char* name_of_direction(int axis) {
  return directions[static_cast<std::size_t>(axis)];
}

Felt felt_by_pose(const AxisPush& push, double smallest) {
  if (std::abs(push.moved) < smallest) return Felt::nothing;
  return push.moved > 0 ? Felt::as_said : Felt::opposite;
}

bool AxisCheck::is_right() const {
  const bool all = std::all_of(felt.begin(), felt.end(), [](Felt one) { return one == Felt::as_said; });
  return all && !ended && fault == Fault::none && signs.position == Vec3(1);
}

AxisCheck check_axes(Stylus& stylus, const AxisHand& hand, const std::function<double()>& next,
                     const AxisCheckSettings& settings) {
  AxisCheck check;
  Pusher pusher(stylus, next, settings.force);
  const auto is_homing = [&] { return stylus.state() == State::homing; };
  double waited = 0;
  const auto wait = [&] {
    pusher.run(Vec3(0), 0.1);
    waited += 0.1;
  };
  // One that has its home says so with its first pose, a moment after it was opened.
  if (is_homing()) wait();
  if (is_homing()) hand.home();
  while (is_homing() && waited < settings.homing_time) wait();
  check.ended = !can_push(stylus.state());
  for (int axis = 0; axis < 3 && !check.ended && check.fault == Fault::none; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    AxisPush push{.axis = axis, .force = settings.force};
    if (!hand.ready(push)) {
      check.ended = true;
      break;
    }
    Vec3 along(0);
    along[axis] = settings.force;
    const Vec3 before = pusher.run(Vec3(0), 0.2);
    const Vec3 after = pusher.push(along, settings.push_time);
    check.fault = pusher.result.fault;
    pusher.release();
    push.moved = check.moved[at] = (after - before)[axis];
    if (check.fault != Fault::none) break;
    check.felt[at] = hand.felt(push);
    check.ended = check.felt[at] == Felt::stop;
    if (check.ended || check.felt[at] == Felt::nothing) continue;
    check.signs.force[axis] = sign_of(check.felt[at]);
    const bool moved = std::abs(push.moved) >= settings.smallest;
    if (moved && (push.moved > 0) != (check.felt[at] == Felt::as_said)) check.signs.position[axis] = -1;
  }
  stylus.write_force(Vec3(0));
  return check;
}

}  // namespace palpate::device
