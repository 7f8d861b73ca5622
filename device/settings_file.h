#pragma once

/// A device's settings as JSON: one object, whose keys are the names of the settings.

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "device/messages.h"

namespace palpate::device {

class SettingsReader {
 public:
  explicit SettingsReader(nlohmann::json json) : left_(std::move(json)) {
    if (!left_.is_object()) throw Refusal(say("not-a-json-object"));
  }
  /// Takes the value of a key out of what is left to be read; without the key the value stays.
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
  /// Nothing may be left.
  void finish() const {
    if (!left_.empty()) throw Refusal(say("not-a-setting", left_.begin().key()));
  }

 private:
  nlohmann::json left_;
};

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

}  // namespace palpate::device
