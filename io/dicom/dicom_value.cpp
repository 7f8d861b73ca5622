#include "io/dicom/dicom_value.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcbytstr.h>
#include <dcmtk/dcmdata/dcelem.h>
#include <dcmtk/dcmdata/dcitem.h>
#include <dcmtk/dcmdata/dcsequen.h>
#include <dcmtk/dcmdata/dctagkey.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "io/dicom/asked_for.h"

namespace palpate::io::internal {
namespace {

// A dataset contains only attributes in the list of is_asked_for(): one missing from the list must not seem missing
// from the file.
void check_asked_for(const DcmItem& item, const DcmTagKey& tag) {
  const std::uint32_t number = std::uint32_t{tag.getGroup()} << 16 | tag.getElement();
  if (item.ident() == EVR_dataset && !is_asked_for(number) && !is_asked_for_of_structures(number)) {
    throw std::logic_error(std::string(tag.toString().c_str()) + " has to be added to is_asked_for()");
  }
}

// Elements stand in the order of their tags. DCMTK's own search goes on to the last for each that is absent, as most
// are, and keeps a stack on the heap.
DcmElement* element_of(DcmItem& item, const DcmTagKey& tag) {
  check_asked_for(item, tag);
  DcmObject* at = item.nextInContainer(nullptr);
  while (at != nullptr && at->getTag() < tag) at = item.nextInContainer(at);
  return at != nullptr && at->getTag() == tag ? dynamic_cast<DcmElement*>(at) : nullptr;
}

bool is_unknown(DcmElement& element) {
  return element.getVR() == EVR_UN || element.getVR() == EVR_UNKNOWN;
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

std::string text_in(DcmElement& element) {
  OFString value;
  if (element.getOFStringArray(value, OFTrue).bad()) return {};
  return std::string(trimmed(std::string_view(value.c_str(), value.length())));
}

}  // namespace

std::string text_of(DcmItem& item, const DcmTagKey& tag) {
  DcmElement* const element = element_of(item, tag);
  return element != nullptr ? text_in(*element) : std::string();
}

std::string code_value(DcmItem& item) {
  for (const DcmTagKey& place : {DCM_CodeValue, DCM_LongCodeValue, DCM_URNCodeValue}) {
    if (std::string value = text_of(item, place); !value.empty()) return value;
  }
  return {};
}

std::vector<double> numbers_of(DcmItem& item, const DcmTagKey& tag) {
  DcmElement* element = element_of(item, tag);
  if (element == nullptr || element->isEmpty()) return {};
  if (auto* const text = dynamic_cast<DcmByteString*>(element)) {
    // Taken as the raw text, because DCMTK's lists of values take a time quadratic in their number.
    char* letters = nullptr;
    Uint32 count = 0;
    if (text->getString(letters, count).bad() || letters == nullptr) return {};
    return parsed_list(std::string_view(letters, count));
  }
  if (Uint8* bytes = nullptr; is_unknown(*element) && element->getUint8Array(bytes).good()) {
    return parsed_list(
        {reinterpret_cast<const char*>(bytes), element->getLength()});  // private, and not in a dictionary
  }
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
  auto* const found = dynamic_cast<DcmSequenceOfItems*>(element_of(item, sequence));
  return found != nullptr && found->card() > 0 ? found->getItem(0) : nullptr;
}

}  // namespace palpate::io::internal
