#include "io/dicom/csa_header.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

namespace palpate::io::internal {
namespace {

class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::optional<std::span<const std::byte>> take(std::size_t count) {
    if (count > rest_.size()) return std::nullopt;
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  std::optional<std::uint32_t> take_u32() {
    const auto bytes = take(4);
    if (!bytes) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>((*bytes)[i]);
    return value;
  }

 private:
  std::span<const std::byte> rest_;
};

// Up to the first zero byte.
std::string_view csa_text(std::span<const std::byte> bytes) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return all.substr(0, all.find('\0'));
}

std::optional<double> csa_number(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end != text.data() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::vector<double> csa_numbers(std::span<const std::byte> header, std::string_view name) {
  Cursor cursor(header);
  const auto magic = cursor.take(8);
  const auto tags = cursor.take_u32();
  if (!magic || csa_text(magic->first(4)) != "SV10" || !tags || !cursor.take_u32()) return {};
  for (std::uint32_t tag = 0; tag < *tags; ++tag) {
    const auto tag_name = cursor.take(64);
    const bool described = tag_name && cursor.take(12);  // multiplicity, VR, type
    const auto items = described ? cursor.take_u32() : std::nullopt;
    if (!items || !cursor.take_u32()) return {};
    std::vector<double> numbers;
    for (std::uint32_t item = 0; item < *items; ++item) {
      const auto lengths = cursor.take(16);
      if (!lengths) return {};
      const auto length = Cursor(lengths->subspan(4)).take_u32();
      const auto value = length ? cursor.take((static_cast<std::size_t>(*length) + 3) / 4 * 4) : std::nullopt;
      if (!value) return {};
      if (const auto number = csa_number(csa_text(value->first(*length)))) numbers.push_back(*number);
    }
    if (csa_text(*tag_name) == name) return numbers;
  }
  return {};
}

}  // namespace palpate::io::internal
