#pragma once

/// A device's settings as JSON: one object, whose keys are the names of the settings.

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "device/axis_signs.h"
#include "device/device_type.h"
#include "device/messages.h"
#include "device/setting_limits.h"

namespace palpate::device {

class SettingsReader {
 public:
  explicit SettingsReader(nlohmann::json json) : left_(std::move(json)) {
    if (!left_.is_object()) throw Refusal(say("not-a-json-object"));
  }
  /// Reads a key's value and marks it as read; without the key the value does not change.
  template <typename T>
  void take(const char* key, T& value) {
    const auto found = left_.find(key);
    if (found == left_.end()) return;
    try {
      value = found->template get<T>();
    } catch (const nlohmann::json::exception&) {
      throw Refusal(say("not-a-usable-setting", key, found->dump()));
    }
    left_.erase(found);
  }
  /// Throws std::runtime_error naming a key that was not read.
  void finish() const {
    if (!left_.empty()) throw Refusal(say("not-a-setting", left_.begin().key()));
  }

 private:
  nlohmann::json left_;
};

/// Three times 1 or -1. Throws std::runtime_error naming the key.
inline void take_signs(SettingsReader& reader, const char* key, Vec3& signs) {
  std::array<double, 3> values{signs.x, signs.y, signs.z};
  reader.take(key, values);
  for (const double value : values) {
    if (std::abs(value) != 1) throw Refusal(say("axis-signs-are-1-or-1", key));
  }
  signs = {values[0], values[1], values[2]};
}

/// The settings that all kinds with motors have. Throws std::runtime_error naming a limit beyond its ceiling.
template <typename Settings>
void take_common(SettingsReader& reader, Settings& settings, const SettingLimits& most) {
  reader.take("address", settings.address);
  reader.take("maximum_force", settings.maximum_force);
  reader.take("stiffness_limit", settings.stiffness_limit);
  reader.take("guarded", settings.guarded);
  take_signs(reader, "position_signs", settings.signs.position);
  take_signs(reader, "force_signs", settings.signs.force);
  if (const Text wrong = wrong_limit(settings, most); !wrong.empty()) throw Refusal(wrong);
}

/// read(SettingsReader&) makes the settings. Throws std::runtime_error naming the device, the file, the key and what is
/// wrong with it.
template <typename Read>
auto read_settings_file(const std::string& device, const std::string& file, const Read& read) {
  std::ifstream stream(file);
  if (!stream) throw Refusal(say("settings-cannot-be-read", device, file));
  try {
    SettingsReader reader(nlohmann::json::parse(stream));
    auto settings = read(reader);
    reader.finish();
    return settings;
  } catch (const std::exception& error) {
    throw Refusal(say("settings-refused", device, file, error.what()));
  }
}

/// The stylus that a user chose: from the settings file if there is one, else from `settings`; then with the chosen
/// address and firmware.
template <typename Settings>
std::shared_ptr<Stylus> make_with_settings(const DeviceChoice& choice, Settings (*read)(const std::string& file),
                                           std::unique_ptr<Stylus> (*make)(const Settings& settings),
                                           Settings settings = {}) {
  if (!choice.settings.empty()) settings = read(choice.settings);
  if (!choice.address.empty()) settings.address = choice.address;
  if constexpr (requires { settings.firmware_file; }) {
    if (!choice.firmware.empty()) settings.firmware_file = choice.firmware;
  }
  return make(settings);
}

}  // namespace palpate::device
