#include <array>
#include <stdexcept>
#include <string>

#include "device/messages.h"
#include "device/settings_file.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {

namespace {

void require(bool holds, const Text& what) {
  if (!holds) throw Refusal(at_place("WoodenHaptics", what));
}

void require_near(const char* key, double value, double usual, double factor, const std::string& axis = "") {
  const Text wrong = wrong_calibration(key, value, usual, factor, axis);
  require(wrong.empty(), wrong);
}

/// A for each N at the end of the bodies that a motor turns, where they are stretched.
double current_of_a_force(const WoodenHapticsSettings& s, std::size_t axis) {
  const std::array levers{s.lower_length + s.upper_length, s.lower_length, s.upper_length};
  return levers[axis] * s.capstan_diameter[axis] / s.body_diameter[axis] / s.torque_constant[axis];
}

constexpr const char* preset_names = "2015, 2016, 2019 or woody";

WoodenHapticsSettings read(SettingsReader& reader) {
  std::string preset;
  reader.take("preset", preset);
  WoodenHapticsSettings s = wooden_haptics_preset(preset);
  reader.take("short_reports", s.short_reports);
  reader.take("stylus_button", s.stylus_button);
  reader.take("continuous_current", s.continuous_current);
  reader.take("capstan_diameter", s.capstan_diameter);
  reader.take("body_diameter", s.body_diameter);
  reader.take("base_height", s.base_height);
  reader.take("lower_length", s.lower_length);
  reader.take("upper_length", s.upper_length);
  reader.take("origin", s.origin);
  reader.take("workspace_radius", s.workspace_radius);
  reader.take("torque_constant", s.torque_constant);
  reader.take("counts_per_turn", s.counts_per_turn);
  reader.take("encoder_sign", s.encoder_sign);
  reader.take("motor_aligned", s.motor_aligned);
  reader.take("home_counts", s.home_counts);
  reader.take("current_limit", s.current_limit);
  take_common(reader, s, {});
  check(s);
  return s;
}

}  // namespace

WoodenHapticsSettings wooden_haptics_preset(const std::string& name) {
  WoodenHapticsSettings s;
  s.preset = name;
  if (name == "woody") return s;
  s.motor_aligned = {false, false, false};
  s.home_counts = {0, 0, 6000};
  if (name == "2015") return s;
  if (name == "2019") {
    s.torque_constant = {0.321, 0.0603, 0.0603};
    return s;
  }
  if (name == "2016") {
    s.short_reports = true;
    s.motor_aligned = {false, true, true};
    s.encoder_sign = {-1, 1, 1};
    s.home_counts = {0, 0, -6000};
    return s;
  }
  require(false, say("name-the-arm-as-preset", preset_names));
  return s;
}

void check(const WoodenHapticsSettings& settings) {
  const WoodenHapticsSettings usual = wooden_haptics_preset(settings.preset);
  require_near("lower_length", settings.lower_length, usual.lower_length, dimension_factor);
  require_near("upper_length", settings.upper_length, usual.upper_length, dimension_factor);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis = std::string(" of axis ") + "abc"[i];
    require_near("capstan_diameter", settings.capstan_diameter[i], usual.capstan_diameter[i], dimension_factor, axis);
    require_near("body_diameter", settings.body_diameter[i], usual.body_diameter[i], dimension_factor, axis);
    require_near("torque_constant", settings.torque_constant[i], usual.torque_constant[i], calibration_factor, axis);
    require_near("counts_per_turn", settings.counts_per_turn[i], usual.counts_per_turn[i], calibration_factor, axis);
    // Each may be near, and all together not.
    const double times = current_of_a_force(settings, i) / current_of_a_force(usual, i);
    require(is_near(times, 1), say("forces-would-be-multiplied", axis, short_number(times),
                                   short_number(1 / calibration_factor), short_number(calibration_factor)));
    require(settings.encoder_sign[i] == 1 || settings.encoder_sign[i] == -1, say("encoder-sign-is-1-or-1", axis));
    require(settings.home_counts[i] >= -32768 && settings.home_counts[i] <= 32767,
            say("home-counts-must-fit-16-bits", axis));
  }
  require(settings.continuous_current > 0 && settings.continuous_current <= settings.current_limit,
          say("continuous-current-lies-between-0"));
  require(settings.workspace_radius > 0 && settings.workspace_radius <= 1, say("workspace-radius-lies-within-1-m"));
  require(settings.current_limit > 0 && settings.current_limit <= 3, say("current-limit-lies-between-0"));
  check_limits("WoodenHaptics", settings, {});
}

WoodenHapticsSettings read_wooden_haptics(const std::string& json_file) {
  return read_settings_file("WoodenHaptics", json_file, read);
}

}  // namespace palpate::device
