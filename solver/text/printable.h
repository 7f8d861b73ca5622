#pragma once

/// Text for a terminal. What comes out of a file (its name, a description, a patient's name) may hold control
/// characters, which a terminal would obey.

#include <string>
#include <string_view>

namespace palpate {

namespace internal {

/// `escape` is what stands before a control character's two hexadecimal digits: those of ASCII but for the end of a
/// line, of DEL, and of C1 (U+0080 to U+009F) as UTF-8 writes them.
inline std::string without_control(std::string_view text, std::string_view escape, bool ascii) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string shown;
  for (std::size_t n = 0; n < text.size(); ++n) {
    auto byte = static_cast<unsigned char>(text[n]);
    const auto next = n + 1 < text.size() ? static_cast<unsigned char>(text[n + 1]) : 0U;
    const bool is_control = (ascii && byte < 0x20 && byte != '\n') || byte == 0x7F;
    const bool is_c1 = byte == 0xC2 && next >= 0x80 && next < 0xA0;
    if (!is_control && !is_c1) {
      shown += text[n];
      continue;
    }
    if (is_c1) {
      byte = static_cast<unsigned char>(next);
      ++n;
    }
    shown.append(escape) += digits[byte >> 4U];
    shown += digits[byte & 15U];
  }
  return shown;
}

}  // namespace internal

/// With control characters in the form \x1b.
inline std::string printable(std::string_view text) {
  return internal::without_control(text, "\\x", true);
}

/// The same of JSON, which writes those of ASCII by itself, in its own form: \u009b.
inline std::string printable_json(std::string_view json) {
  return internal::without_control(json, "\\u00", false);
}

}  // namespace palpate
