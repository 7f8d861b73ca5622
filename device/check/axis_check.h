#pragma once

/// Pushes a stylus gently along each axis in turn, through the safety filter, and finds the directions of its axes.
/// What the user felt gives the sign of the force; how the pose moved gives the sign of the position.

#include <array>
#include <functional>

#include "device/axis_signs.h"
#include "device/safety/safety_filter.h"
#include "device/stylus.h"

namespace palpate::device {

/// One push. Device frame: axis 0 is to the right, 1 up, 2 towards the user.
struct AxisPush {
  int axis;
  double force;      ///< N, along the axis
  double moved = 0;  ///< m along the axis, by the pose; set after the push
};

/// The user's answer about a push.
enum class Felt { as_said, opposite, nothing, stop };

struct AxisHand {
  /// Called before each push; false ends the check.
  std::function<bool(const AxisPush&)> ready;
  /// Called after each push.
  std::function<Felt(const AxisPush&)> felt;
  /// Called once, while the stylus waits to be homed.
  std::function<void()> home;
};

struct AxisCheckSettings {
  double force = 0.2;         ///< N
  double push_time = 1.2;     ///< s; the second half has the whole force
  double smallest = 0.3e-3;   ///< m: a smaller motion counts as none
  double homing_time = 60.0;  ///< s that the user has for homing
};

struct AxisCheck {
  std::array<Felt, 3> felt{Felt::nothing, Felt::nothing, Felt::nothing};
  std::array<double, 3> moved{};  ///< m, by the pose
  AxisSigns signs;                ///< to be multiplied with those of the stylus
  bool ended = false;             ///< the user ended it, or the stylus was not homed
  Fault fault = Fault::none;      ///< the fault that the filter latched; it ends the check

  /// Whether every push was felt in the announced direction.
  bool is_right() const;
};

/// The stylus is open, and has no force before and after. `next` waits for the next millisecond and returns the time,
/// s.
AxisCheck check_axes(Stylus& stylus, const AxisHand& hand, const std::function<double()>& next,
                     const AxisCheckSettings& settings = {});

/// The answer that the pose implies, for a stylus whose positions have the right sign.
Felt felt_by_pose(const AxisPush& push, double smallest = AxisCheckSettings{}.smallest);

/// "to the right", "up", "towards you".
const char* name_of_direction(int axis);

}  // namespace palpate::device
