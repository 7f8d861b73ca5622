#include "palpate/io/internal/dicom_value.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcchrstr.h>
#include <dcmtk/dcmdata/dcelem.h>
#include <dcmtk/dcmdata/dcitem.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmdata/dctagkey.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "palpate/io/internal/asked_for.h"

namespace palpate::io::internal {
namespace {

// A dataset holds only what is asked for: what is missing from that list must not seem to be missing from the file.
void check_asked_for(const DcmItem& item, const DcmTagKey& tag) {
  if (item.ident() == EVR_dataset && !is_asked_for(std::uint32_t{tag.getGroup()} << 16 | tag.getElement())) {
    throw std::logic_error(std::string(tag.toString().c_str()) + " has to be added to is_asked_for()");
  }
}

DcmElement* element_of(DcmItem& item, const DcmTagKey& tag) {
  check_asked_for(item, tag);
  DcmElement* element = nullptr;
  return item.findAndGetElement(tag, element).good() ? element : nullptr;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank(" \0\t\r\n", 5);
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

// Independent of the locale, unlike the C library's.
std::optional<double> parsed(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<double> parsed_list(std::string_view text) {
  std::vector<double> values;
  while (true) {
    const auto separator = text.find('\\');
    const auto value = parsed(text.substr(0, separator));
    if (!value) return {};
    values.push_back(*value);
    if (separator == std::string_view::npos) return values;
    text.remove_prefix(separator + 1);
  }
}

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

}  // namespace

std::string text_of(DcmItem& item, const DcmTagKey& tag) {
  DcmElement* element = element_of(item, tag);
  OFString value;
  if (element == nullptr || element->getOFStringArray(value, OFTrue).bad()) return {};
  return std::string(trimmed(std::string_view(value.c_str(), value.length())));
}

std::vector<double> numbers_of(DcmItem& item, const DcmTagKey& tag) {
  DcmElement* element = element_of(item, tag);
  if (element == nullptr || element->isEmpty()) return {};
  if (dynamic_cast<DcmByteString*>(element) != nullptr) return parsed_list(text_of(item, tag));
  std::vector<double> values;
  const unsigned long count = std::min<unsigned long>(element->getNumberOfValues(), 1UL << 16);
  for (unsigned long i = 0; i < count; ++i) {
    Float64 real = 0;
    Float32 single = 0;
    Uint16 u16 = 0;
    Sint16 s16 = 0;
    Uint32 u32 = 0;
    Sint32 s32 = 0;
    if (element->getFloat64(real, i).good()) {
      values.push_back(real);
    } else if (element->getFloat32(single, i).good()) {
      values.push_back(single);
    } else if (element->getUint16(u16, i).good()) {
      values.push_back(u16);
    } else if (element->getSint16(s16, i).good()) {
      values.push_back(s16);
    } else if (element->getUint32(u32, i).good()) {
      values.push_back(u32);
    } else if (element->getSint32(s32, i).good()) {
      values.push_back(s32);
    } else {
      return {};
    }
    if (!std::isfinite(values.back())) return {};
  }
  return values;
}

std::optional<double> number_of(DcmItem& item, const DcmTagKey& tag) {
  const auto values = numbers_of(item, tag);
  return values.empty() ? std::nullopt : std::optional(values.front());
}

DcmItem* first_item(DcmItem& item, const DcmTagKey& sequence) {
  check_asked_for(item, sequence);
  DcmItem* found = nullptr;
  return item.findAndGetSequenceItem(sequence, found, 0).good() ? found : nullptr;
}

std::string utf8_of(const std::string& text, const std::string& character_set) {
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20; });
  if (plain) return text;
  if (!character_set.empty()) {
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
