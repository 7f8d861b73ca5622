#pragma once

/// Text from other programs as UTF-8, which JSON and its readers need.

#include <algorithm>
#include <string>
#include <string_view>

#include "solver/text/printable.h"

namespace palpate {

/// The text in UTF-8. Bytes that are not UTF-8 are read as ISO 8859-1, in which every byte is a character.
inline std::string utf8_text(std::string_view text) {
  std::string valid;
  for (std::size_t n = 0, length = 0; n < text.size(); n += length) {
    length = internal::utf8_character(text.substr(n));
    if (length > 0) {
      valid.append(text, n, length);
      continue;
    }
    length = 1;
    const auto byte = static_cast<unsigned char>(text[n]);
    valid += static_cast<char>(0xC0U | byte >> 6U);
    valid += static_cast<char>(0x80U | (byte & 0x3FU));
  }
  return valid;
}

/// The text without an incomplete last character of UTF-8, which was cut because the buffer was too small.
inline std::string_view without_cut_character(std::string_view text) {
  constexpr std::size_t most_missing = 3;
  for (std::size_t tail = 1; tail <= std::min(most_missing, text.size()); ++tail) {
    const auto first = static_cast<unsigned char>(text[text.size() - tail]);
    if (first >= 0x80 && first < 0xC0) continue;  // not the first byte of its character
    const std::size_t length = first < 0xC2 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 1;
    return length > tail ? text.substr(0, text.size() - tail) : text;
  }
  return text;
}

}  // namespace palpate
