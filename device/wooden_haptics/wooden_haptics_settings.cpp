#include <stdexcept>

#include "device/settings_file.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {

namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error("WoodenHaptics: " + what);
}

constexpr const char* preset_names = "2015, 2016, 2019 or woody";

WoodenHapticsSettings read(SettingsReader& reader) {
  std::string preset;
  reader.take("preset", preset);
  WoodenHapticsSettings s = wooden_haptics_preset(preset);
  reader.take("short_reports", s.short_reports);
  reader.take("continuous_current", s.continuous_current);
  reader.take("address", s.address);
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
  reader.take("maximum_force", s.maximum_force);
  reader.take("stiffness_limit", s.stiffness_limit);
  reader.take("guarded", s.guarded);
  reader.finish();
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
  require(false, std::string("name the arm as \"preset\" in its settings file: ") + preset_names);
  return s;
}

void check(const WoodenHapticsSettings& settings) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis = std::string(" of axis ") + "abc"[i];
    require(settings.capstan_diameter[i] > 0 && settings.body_diameter[i] > settings.capstan_diameter[i],
            "the diameters" + axis + " must be above zero, the body's above the capstan's");
    require(settings.torque_constant[i] > 0, "the torque constant" + axis + " must be above zero");
    require(settings.counts_per_turn[i] > 0, "the counts per turn" + axis + " must be above zero");
    require(settings.encoder_sign[i] == 1 || settings.encoder_sign[i] == -1, "the encoder sign" + axis + " is 1 or -1");
    require(settings.home_counts[i] >= -32768 && settings.home_counts[i] <= 32767,
            "the home counts" + axis + " must fit 16 bits");
  }
  require(!settings.preset.empty(), std::string("name the arm as \"preset\" in its settings file: ") + preset_names);
  require(settings.continuous_current > 0 && settings.continuous_current <= settings.current_limit,
          "the continuous current lies between 0 and the current limit");
  require(settings.lower_length > 0 && settings.upper_length > 0, "the lengths of the bodies must be above zero");
  require(settings.workspace_radius > 0 && settings.workspace_radius <= 1, "the workspace's radius lies within 1 m");
  require(settings.current_limit > 0 && settings.current_limit <= 3, "the current limit lies between 0 and 3 A");
  require(settings.maximum_force > 0 && settings.maximum_force <= 20, "the largest force lies between 0 and 20 N");
  require(settings.stiffness_limit > 0, "the stiffness limit must be above zero");
}

WoodenHapticsSettings read_wooden_haptics(const std::string& json_file) {
  return read_settings_file("WoodenHaptics", json_file, read);
}

}  // namespace palpate::device
