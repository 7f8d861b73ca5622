#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {

namespace {

using Json = nlohmann::json;

void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error("WoodenHaptics: " + what);
}

/// Takes the value of a key out of what is left to be read.
template <typename T>
void take(Json& left, const char* key, T& value) {
  const auto found = left.find(key);
  if (found == left.end()) return;
  try {
    value = found->get<T>();
  } catch (const Json::exception&) {
    throw std::runtime_error(std::string("'") + key + "' is not what it should be: " + found->dump());
  }
  left.erase(found);
}

constexpr const char* preset_names = "2015, 2016, 2019 or woody";

WoodenHapticsSettings settings_of(Json json) {
  if (!json.is_object()) throw std::runtime_error("it is not a JSON object");
  std::string preset;
  take(json, "preset", preset);
  WoodenHapticsSettings s = wooden_haptics_preset(preset);
  take(json, "short_reports", s.short_reports);
  take(json, "continuous_current", s.continuous_current);
  take(json, "address", s.address);
  take(json, "capstan_diameter", s.capstan_diameter);
  take(json, "body_diameter", s.body_diameter);
  take(json, "base_height", s.base_height);
  take(json, "lower_length", s.lower_length);
  take(json, "upper_length", s.upper_length);
  take(json, "origin", s.origin);
  take(json, "workspace_radius", s.workspace_radius);
  take(json, "torque_constant", s.torque_constant);
  take(json, "counts_per_turn", s.counts_per_turn);
  take(json, "encoder_sign", s.encoder_sign);
  take(json, "motor_aligned", s.motor_aligned);
  take(json, "home_counts", s.home_counts);
  take(json, "current_limit", s.current_limit);
  take(json, "maximum_force", s.maximum_force);
  take(json, "stiffness_limit", s.stiffness_limit);
  take(json, "guarded", s.guarded);
  if (!json.empty()) throw std::runtime_error("'" + json.begin().key() + "' is not a setting");
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
  std::ifstream stream(json_file);
  if (!stream)
    throw std::runtime_error("WoodenHaptics: " + json_file + " cannot be read; name the file of the arm's geometry");
  try {
    return settings_of(Json::parse(stream));
  } catch (const std::exception& error) {
    throw std::runtime_error("WoodenHaptics: " + json_file + ": " + error.what());
  }
}

}  // namespace palpate::device
