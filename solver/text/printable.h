#pragma once

/// Text for a terminal or a script. Text from a file (its name, a description, a patient's name) may hold control
/// characters, which a terminal would obey, and bytes that are not UTF-8, at which a script would stop.

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate {

namespace internal {

/// The length in bytes of the first character of a text that is not empty; 0 if it is not UTF-8 (RFC 3629, 4).
inline std::size_t utf8_character(std::string_view text) {
  const auto byte = [&](std::size_t n) { return n < text.size() ? static_cast<unsigned char>(text[n]) : 0U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  // After some first bytes the second has a smaller range: the rest would be overlong forms, surrogates, or beyond
  // U+10FFFF.
  const unsigned least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (length == 0 || byte(1) < least || byte(1) > most) return 0;
  for (std::size_t n = 2; n < length; ++n) {
    if (byte(n) < 0x80 || byte(n) > 0xBF) return 0;
  }
  return length;
}

/// `escape` precedes the two hexadecimal digits of a byte that is not UTF-8 or of a control character. Those are
/// ASCII's (except the end of a line), DEL, and C1 (U+0080 to U+009F) in UTF-8.
inline std::string without_control(std::string_view text, std::string_view escape, bool ascii) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string shown;
  for (std::size_t n = 0, length = 0; n < text.size(); n += length) {
    const std::size_t whole = utf8_character(text.substr(n));
    length = whole == 0 ? 1 : whole;
    auto byte = static_cast<unsigned char>(text[n]);
    const bool is_control = (ascii && byte < 0x20 && byte != '\n') || byte == 0x7F;
    const bool is_c1 = whole == 2 && byte == 0xC2 && static_cast<unsigned char>(text[n + 1]) < 0xA0;
    if (whole != 0 && !is_control && !is_c1) {
      shown.append(text, n, length);
      continue;
    }
    if (is_c1) byte = static_cast<unsigned char>(text[n + 1]);
    shown.append(escape) += digits[byte >> 4U];
    shown += digits[byte & 15U];
  }
  return shown;
}

}  // namespace internal

/// Writes control characters, and bytes that are not UTF-8, in the form \x1b.
inline std::string printable(std::string_view text) {
  return internal::without_control(text, "\\x", true);
}

/// The same for JSON in JSON's own form, \u009b. The JSON library escapes the control characters of ASCII by itself.
inline std::string printable_json(std::string_view json) {
  return internal::without_control(json, "\\u00", false);
}

}  // namespace palpate
