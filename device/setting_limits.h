#pragma once

/// The largest force and stiffness in settings: one check for every kind of device with motors.

#include <cstdio>
#include <string>

#include "device/messages.h"
#include "device/safety/safety_limits.h"

namespace palpate::device {

/// The limits of a kind of device. None is above the ceiling of the whole chain.
struct SettingLimits {
  double force_n = ceiling::force_n;
  double stiffness_n_per_m = ceiling::stiffness_n_per_m;
  bool tells_force = false;      ///< a largest force of 0 is allowed: then the device's own figure is used
  bool tells_stiffness = false;  ///< the same for a stiffness limit of 0
};

/// A message about a wrong limit in these settings; empty if they are right.
template <typename Settings>
Text wrong_limit(const Settings& settings, const SettingLimits& most) {
  const auto lies_within = [](double value, double highest, bool may_be_zero) {
    return (value > 0 || (may_be_zero && value == 0)) && value <= highest;
  };
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return std::string(text);
  };
  if (!lies_within(settings.maximum_force, most.force_n, most.tells_force)) {
    return say("largest-force-lies-between", number(most.force_n));
  }
  if (!lies_within(settings.stiffness_limit, most.stiffness_n_per_m, most.tells_stiffness)) {
    return say("stiffness-limit-lies-between", number(most.stiffness_n_per_m));
  }
  return {};
}

/// Throws std::runtime_error that begins with `device` and names the limit.
template <typename Settings>
void check_limits(const char* device, const Settings& settings, const SettingLimits& most) {
  const Text wrong = wrong_limit(settings, most);
  if (!wrong.empty()) throw Refusal(at_place(device, wrong));
}

}  // namespace palpate::device
