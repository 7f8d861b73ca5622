#pragma once

/// Parses JSON, with errors that name the source of the text. Not installed.

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "modes/messages.h"
#include "modes/scene/refuse.h"

namespace palpate::modes {

/// The text as JSON. Refuses a key that is given twice: the library would silently keep the last.
inline nlohmann::json parsed(std::string_view text) {
  std::vector<std::set<std::string>> open;
  const auto check = [&open](int depth, nlohmann::json::parse_event_t event, nlohmann::json& key) {
    constexpr int deepest = 64;
    if (depth > deepest) throw InvalidInput(say("nested-too-deep", deepest));
    if (event == nlohmann::json::parse_event_t::object_start) {
      open.emplace_back();
    } else if (event == nlohmann::json::parse_event_t::object_end) {
      open.pop_back();
    } else if (event == nlohmann::json::parse_event_t::key && !open.back().insert(key.get<std::string>()).second) {
      refuse(key.get<std::string>(), say("given-twice"));
    }
    return true;
  };
  return nlohmann::json::parse(text, check);
}

/// Calls `read`; every error names the source.
template <typename Read>
auto read_from(const std::string& source, const Read& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    const std::string what = error.what();
    const auto end_of_code = what.find("] ");
    throw InvalidInput(say("not-json", source, end_of_code == std::string::npos ? what : what.substr(end_of_code + 2)));
  } catch (const InvalidInput& error) {
    throw InvalidInput(at_place(source, error.text()));
  }
}

}  // namespace palpate::modes
