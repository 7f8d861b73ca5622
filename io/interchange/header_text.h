#pragma once

/// What the text headers of NRRD and MetaImage have in common: fields by their names.

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace palpate::io {

using HeaderFields = std::map<std::string, std::string>;

inline std::string trimmed(const std::string& text) {
  const std::size_t from = text.find_first_not_of(" \t\r");
  return from == std::string::npos ? std::string() : text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

/// The first of several names under which a field goes; empty where there is none.
inline std::string field(const HeaderFields& fields, std::initializer_list<std::string> names) {
  for (const std::string& name : names) {
    if (const auto found = fields.find(name); found != fields.end()) return found->second;
  }
  return {};
}

/// Numbers between spaces, commas and parentheses.
inline std::vector<double> numbers(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream words(text);
  std::vector<double> all;
  for (std::string word; words >> word;) all.push_back(std::strtod(word.c_str(), nullptr));
  return all;
}

}  // namespace palpate::io
