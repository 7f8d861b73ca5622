#pragma once

/// Shared by the text headers of NRRD and MetaImage: lines, and fields by their names.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <istream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {

/// The lines of a header. Throws DicomError after 64 MiB, ten times the longest header known: the header's end is then
/// missing, and values would be read as lines.
class HeaderLines {
 public:
  explicit HeaderLines(std::istream& stream) : stream_(stream) {}

  /// False at the end of the file.
  bool next(std::string& line) {
    line.clear();
    for (int c = stream_.get(); c != std::istream::traits_type::eof(); c = stream_.get()) {
      if (left_-- == 0) throw DicomError(say("voxel-header-has-no-end"));
      if (c == '\n') return true;
      line += static_cast<char>(c);
    }
    return !line.empty();
  }

 private:
  std::istream& stream_;
  std::size_t left_ = std::size_t{1} << 26;
};

using HeaderFields = std::map<std::string, std::string>;

inline std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

inline std::string trimmed(const std::string& text) {
  const std::size_t from = text.find_first_not_of(" \t\r");
  return from == std::string::npos ? std::string() : text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

/// The value of the first of these names that the header has; empty if it has none.
inline std::string field(const HeaderFields& fields, std::initializer_list<std::string> names) {
  for (const std::string& name : names) {
    if (const auto found = fields.find(name); found != fields.end()) return found->second;
  }
  return {};
}

/// The number at the beginning of a word, whatever the program's locale; 0 if there is none.
inline double number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc::result_out_of_range) return number;
  const std::string_view read = word.substr(0, static_cast<std::size_t>(end - word.data()));
  const bool is_small = read.find("e-") != read.npos || read.find("E-") != read.npos;
  return is_small ? 0 : std::copysign(std::numeric_limits<double>::infinity(), word.front() == '-' ? -1 : 1);
}

/// Numbers that are separated by spaces, commas or parentheses.
inline std::vector<double> numbers(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream words(text);
  std::vector<double> all;
  for (std::string word; words >> word;) all.push_back(number_in(word));
  return all;
}

}  // namespace palpate::io
