#pragma once

/// Big-endian numbers and texts of a fixed length, as in OpenIGTLink.

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plugin/openigtlink/say.h"
#include "solver/text/utf8.h"

namespace palpate::plugin::igtl {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

class Writer {
 public:
  template <std::unsigned_integral Number>
  void number(Number value) {
    std::array<std::uint8_t, sizeof(Number)> bytes;
    for (std::size_t byte = 0; byte < sizeof(Number); ++byte) {
      bytes[byte] = static_cast<std::uint8_t>(value >> (8 * (sizeof(Number) - 1 - byte)));
    }
    raw(bytes);
  }
  void real(double value) { number(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
  /// Exactly `room` bytes: cut, or filled with zeros.
  void text(std::string_view text, std::size_t room) {
    text = text.substr(0, room);
    raw(text);
    bytes_.resize(bytes_.size() + room - text.size());
  }
  void raw(ByteView bytes);
  void raw(std::string_view text) { raw(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())); }

  std::size_t size() const noexcept { return bytes_.size(); }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Every call throws InvalidInput if too few bytes are left.
class Reader {
 public:
  explicit Reader(ByteView bytes) : bytes_(bytes) {}

  ByteView raw(std::size_t count) {
    if (count > bytes_.size()) throw InvalidInput(say("igtl-ends-early"));
    const ByteView taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  template <std::unsigned_integral Number>
  Number number() {
    Number value = 0;
    for (const std::uint8_t byte : raw(sizeof(Number))) {
      value = static_cast<Number>(static_cast<std::uint64_t>(value) << 8U | byte);
    }
    return value;
  }
  double real() { return std::bit_cast<float>(number<std::uint32_t>()); }
  /// Of `room` bytes, up to the first zero.
  std::string text(std::size_t room) {
    const ByteView all = raw(room);
    const std::string_view view(reinterpret_cast<const char*>(all.data()), all.size());
    return std::string(view.substr(0, view.find('\0')));
  }
  /// The same as UTF-8 (utf8_text()), without a last character that did not fit in.
  std::string utf8(std::size_t room) {
    const std::string all = text(room);
    return utf8_text(all.size() == room ? without_cut_character(all) : std::string_view(all));
  }
  std::size_t left() const noexcept { return bytes_.size(); }

 private:
  ByteView bytes_;
};

}  // namespace palpate::plugin::igtl
