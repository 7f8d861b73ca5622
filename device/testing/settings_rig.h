#pragma once

/// Shared by tests of settings files: writes one, and tells why one is refused.

#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "device/testing/test_files.h"

namespace palpate::device::settings_rig {

using Json = nlohmann::json;

/// The path of a settings file with this content. The next call writes over it.
inline std::string file_of(const Json& json) {
  static const TestFiles files;
  return files.write("settings.json", json.dump());
}

/// The message of what is thrown; empty: nothing was.
inline std::string refusal_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace palpate::device::settings_rig
