#include "io/dicom/character_set.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <iconv.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace palpate::io::internal {
namespace {

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t more = lead < 0x80                   ? 0
                             : lead >= 0xC2 && lead < 0xE0 ? 1
                             : (lead >> 4) == 0xE          ? 2
                             : lead >= 0xF0 && lead < 0xF5 ? 3
                                                           : 9;
    if (more == 9 || i + more >= text.size()) return false;
    for (std::size_t k = 1; k <= more; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) >> 6) != 2) return false;
    }
    if (lead == 0xE0 && static_cast<unsigned char>(text[i + 1]) < 0xA0) return false;  // longer than needed
    if (lead == 0xED && static_cast<unsigned char>(text[i + 1]) > 0x9F) return false;  // a surrogate
    if (lead == 0xF0 && static_cast<unsigned char>(text[i + 1]) < 0x90) return false;
    if (lead == 0xF4 && static_cast<unsigned char>(text[i + 1]) > 0x8F) return false;
    i += more;
  }
  return true;
}

std::string latin1_to_utf8(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xC0 | (byte >> 6));
      utf8 += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return utf8;
}

// The C library's converter, which keeps the escape sequences' state.
std::optional<std::string> converted(std::string text, const char* from) {
  const iconv_t converter = ::iconv_open("UTF-8", from);
  if (reinterpret_cast<std::intptr_t>(converter) == -1) return std::nullopt;
  std::string utf8(4 * text.size() + 4, '\0');
  char* in = text.data();
  char* out = utf8.data();
  std::size_t in_left = text.size();
  std::size_t out_left = utf8.size();
  const bool done = ::iconv(converter, &in, &in_left, &out, &out_left) != static_cast<std::size_t>(-1);
  ::iconv_close(converter);
  if (!done) return std::nullopt;
  utf8.resize(utf8.size() - out_left);
  return utf8;
}

// Kanji (ISO 2022 IR 87 and 159), which DCMTK cannot convert on top of the C library, and half-width katakana (IR 13),
// bytes of 8 bits between them: PS3.5 annex H.
std::optional<std::string> japanese_to_utf8(std::string_view text) {
  std::string utf8;
  const auto is_katakana = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0xA1 && byte <= 0xDF;
  };
  while (!text.empty()) {
    const auto end = static_cast<std::size_t>(std::find_if(text.begin(), text.end(), is_katakana) - text.begin());
    std::string plain(text.substr(0, end));
    for (std::size_t at = plain.find("\x1B)I"); at != std::string::npos; at = plain.find("\x1B)I")) plain.erase(at, 3);
    const auto part = converted(std::move(plain), "ISO-2022-JP-2");
    if (!part) return std::nullopt;
    utf8 += *part;
    text.remove_prefix(end);
    if (text.empty()) break;
    const int point = 0xFF61 + static_cast<unsigned char>(text.front()) - 0xA1;
    for (const int byte : {0xE0 | point >> 12, 0x80 | (point >> 6 & 0x3F), 0x80 | (point & 0x3F)}) {
      utf8 += static_cast<char>(byte);
    }
    text.remove_prefix(1);
  }
  return utf8;
}

}  // namespace

std::string utf8_of(const std::string& text, const std::string& character_set) {
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20; });
  if (plain) return text;
  if (character_set.find("IR 87") != std::string::npos || character_set.find("IR 159") != std::string::npos) {
    if (auto utf8 = japanese_to_utf8(text)) return *utf8;
  } else if (!character_set.empty()) {
    DcmSpecificCharacterSet converter;
    OFString utf8;
    if (converter.selectCharacterSet(character_set.c_str()).good() &&
        converter.convertString(text.c_str(), utf8, "\\^=").good() && is_utf8({utf8.c_str(), utf8.length()})) {
      return {utf8.c_str(), utf8.length()};
    }
  }
  return is_utf8(text) ? text : latin1_to_utf8(text);
}

}  // namespace palpate::io::internal
