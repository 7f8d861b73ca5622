#pragma once

/// The largest force and stiffness in settings, and the numbers that multiply them: one check for every kind of device
/// with motors.

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

/// A number that multiplies forces or positions differs from the kind's own, or the preset's, by this factor at most.
/// The motors of the arms that their makers built differ by 2.33, usual encoders by 2.05, and a Falcon's true gain from
/// the published one by 1.84. A limit of the force is no bound without this one.
constexpr double calibration_factor = 2.5;
/// The same for a diameter or a length. It acts twice, on the pose and on the force: about the root of that.
constexpr double dimension_factor = 1.6;

inline bool is_near(double value, double usual, double factor = calibration_factor) {
  return value >= usual / factor && value <= usual * factor;
}

inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// A message about a number that is too far from the usual one; empty if it is near. `of`: " of axis a", for example.
inline Text wrong_calibration(const char* key, double value, double usual, double factor = calibration_factor,
                              const std::string& of = "") {
  if (is_near(value, usual, factor)) return {};
  return say("calibration-lies-between", key, of, short_number(value), short_number(usual / factor),
             short_number(usual * factor));
}

/// A message about a wrong limit in these settings; empty if they are right.
template <typename Settings>
Text wrong_limit(const Settings& settings, const SettingLimits& most) {
  const auto lies_within = [](double value, double highest, bool may_be_zero) {
    return (value > 0 || (may_be_zero && value == 0)) && value <= highest;
  };
  if (!lies_within(settings.maximum_force, most.force_n, most.tells_force)) {
    return say("largest-force-lies-between", short_number(most.force_n));
  }
  if (!lies_within(settings.stiffness_limit, most.stiffness_n_per_m, most.tells_stiffness)) {
    return say("stiffness-limit-lies-between", short_number(most.stiffness_n_per_m));
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
