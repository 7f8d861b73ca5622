#pragma once

/// Reading JSON: every error names the path of the bad key, and an unknown key is an error.

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "modes/scene/number_text.h"
#include "modes/scene/refuse.h"

namespace palpate::modes {

/// A value and the path to it.
struct At {
  const nlohmann::json& value;
  std::string path;

  At operator[](std::size_t index) const { return {value.at(index), path + "[" + std::to_string(index) + "]"}; }
};

inline double number(const At& at) {
  if (!at.value.is_number()) {
    refuse(at.path, say("not-a-number", at.value.dump()));
  }
  return at.value.get<double>();
}

inline int integer(const At& at) {
  if (!at.value.is_number_integer() || at.value.get<double>() < -2e9 || at.value.get<double>() > 2e9) {
    refuse(at.path, say("not-a-whole-number", at.value.dump()));
  }
  return at.value.get<int>();
}

inline bool boolean(const At& at) {
  if (!at.value.is_boolean()) {
    refuse(at.path, say("not-true-or-false", at.value.dump()));
  }
  return at.value.get<bool>();
}

inline std::string text(const At& at) {
  if (!at.value.is_string()) {
    refuse(at.path, say("not-a-text-in-quotes", at.value.dump()));
  }
  return at.value.get<std::string>();
}

inline std::size_t length_of_array(const At& at, std::size_t wanted = 0) {
  if (!at.value.is_array() || (wanted != 0 && at.value.size() != wanted)) {
    refuse(at.path, wanted == 0 ? say("not-a-list") : say("not-a-list-of", wanted));
  }
  return at.value.size();
}

inline glm::dvec3 vector3(const At& at) {
  length_of_array(at, 3);
  return {number(at[0]), number(at[1]), number(at[2])};
}

/// The members of an object; done() refuses those that were not read. `whole`: the name of the top level in messages.
class Members {
 public:
  explicit Members(const At& at, const char* whole = "scene") : at_(at) {
    if (!at.value.is_object()) {
      refuse(at.path.empty() ? whole : at.path, say("not-an-object-in-braces"));
    }
  }

  std::string path_of(const std::string& key) const { return at_.path.empty() ? key : at_.path + "." + key; }
  bool has(const std::string& key) {
    known_.insert(key);
    return at_.value.contains(key);
  }
  At get(const std::string& key) {
    if (!has(key)) {
      refuse(path_of(key), say("is-missing"));
    }
    return {at_.value.at(key), path_of(key)};
  }
  /// Reads the value if the key is present.
  template <typename Value, typename Read>
  void optional(const std::string& key, Value& value, const Read& read) {
    if (has(key)) {
      value = read(get(key));
    }
  }
  void done() const {
    for (const auto& [key, value] : at_.value.items()) {
      if (known_.count(key) == 0) {
        std::string known;
        for (const std::string& name : known_) {
          known += (known.empty() ? "" : ", ") + name;
        }
        refuse(path_of(key), say("there-is-no-such-key-here", known));
      }
    }
  }

 private:
  At at_;
  std::set<std::string> known_;
};

}  // namespace palpate::modes
