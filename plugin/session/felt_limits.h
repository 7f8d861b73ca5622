#pragma once

/// The limits of a scene that take effect. A scene may only tighten the ceilings of the program and the device
/// (device/safety/safety_limits.h): a larger value is reduced to the ceiling, and a message says so.

#include <vector>

#include "device/safety/safety_limits.h"
#include "device/stylus.h"
#include "modes/scene/scene.h"
#include "solver/text/message.h"

namespace palpate::plugin {

/// N/m: the scene's stiffness, or the most that the stylus renders stably if that is less.
double stiffness_for(const modes::Scene& scene, const device::Specification& stylus) noexcept;

/// The scene with that stiffness.
modes::Scene suited_to(modes::Scene scene, const device::Specification& stylus);

/// The safety filter's limits for a scene on a device: never above what the program allows and the device can do.
device::SafetyLimits limits_for(const modes::Limits& scene, const device::Specification& device) noexcept;

/// A sentence for each limit of the scene that is reduced for this stylus. None for a stylus without motors.
std::vector<Text> drawn_down(const modes::Scene& scene, const device::Specification& stylus);

}  // namespace palpate::plugin
