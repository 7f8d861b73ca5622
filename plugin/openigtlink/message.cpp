#include "plugin/openigtlink/message.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate::plugin::igtl {
namespace {

constexpr std::uint64_t polynomial = 0x42F0E1EBA9EA3693;
constexpr std::size_t extended_header_size = 12;
constexpr double fractions_per_s = 4294967296.0;

constexpr std::array<std::uint64_t, 256> checksum_table = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t value = byte << 56U;
    for (int bit = 0; bit < 8; ++bit) value = value << 1U ^ ((value >> 63U) != 0 ? polynomial : 0);
    table[byte] = value;
  }
  return table;
}();

/// Seconds and their fraction: 32 bits each.
std::uint64_t stamp_of(double time_s) {
  if (!(time_s > 0) || time_s >= fractions_per_s) return 0;
  const double whole = std::floor(time_s);
  return static_cast<std::uint64_t>(whole) << 32U | static_cast<std::uint64_t>((time_s - whole) * fractions_per_s);
}

Bytes body_of_version_2(const Message& message) {
  Writer metadata_header, metadata;
  metadata_header.number(static_cast<std::uint16_t>(message.metadata.size()));
  for (const auto& [key, value] : message.metadata) {
    metadata_header.number(static_cast<std::uint16_t>(key.size()));
    metadata_header.number(std::uint16_t{3});  // US-ASCII, as MIBenum has it
    metadata_header.number(static_cast<std::uint32_t>(value.size()));
    metadata.raw(key);
    metadata.raw(value);
  }
  Writer body;
  body.number(static_cast<std::uint16_t>(extended_header_size));
  body.number(static_cast<std::uint16_t>(metadata_header.size()));
  body.number(static_cast<std::uint32_t>(metadata.size()));
  body.number(std::uint32_t{0});  // the message's id
  body.raw(message.content);
  body.raw(metadata_header.take());
  body.raw(metadata.take());
  return body.take();
}

}  // namespace

std::uint64_t checksum(ByteView bytes, std::uint64_t before) noexcept {
  std::uint64_t value = before;
  for (const std::uint8_t byte : bytes) value = value << 8U ^ checksum_table[(value >> 56U) ^ byte];
  return value;
}

void append(Bytes& wire, const Message& message, std::uint16_t version) {
  const Bytes extended = version >= 2 ? body_of_version_2(message) : Bytes();
  const ByteView body = version >= 2 ? ByteView(extended) : ByteView(message.content);
  Writer header;
  header.number(version);
  header.text(message.type, type_size);
  header.text(message.device, device_size);
  header.number(stamp_of(message.time_s));
  header.number(static_cast<std::uint64_t>(body.size()));
  header.number(checksum(body));
  const Bytes head = header.take();
  wire.insert(wire.end(), head.begin(), head.end());
  wire.insert(wire.end(), body.begin(), body.end());
}

Header read_header(ByteView bytes) {
  Reader reader(bytes);
  Header header;
  header.version = reader.number<std::uint16_t>();
  header.type = reader.text(type_size);
  header.device = reader.utf8(device_size);  // becomes the name of a structure
  const auto stamp = reader.number<std::uint64_t>();
  header.time_s = static_cast<double>(stamp >> 32U) + static_cast<double>(stamp & 0xFFFFFFFFU) / fractions_per_s;
  header.body_size = reader.number<std::uint64_t>();
  header.checksum = reader.number<std::uint64_t>();
  if (header.version < 1 || header.version > 3 || header.type.empty()) throw InvalidInput(say("igtl-not-a-message"));
  return header;
}

Message read_message(const Header& header, Bytes body) {
  Message message{.type = header.type, .device = header.device, .time_s = header.time_s, .content = {}};
  if (header.version < 2) {
    message.content = std::move(body);
    return message;
  }
  Reader reader(body);
  const std::size_t extended_size = reader.number<std::uint16_t>();
  const std::size_t metadata_header_size = reader.number<std::uint16_t>();
  const std::size_t metadata_size = reader.number<std::uint32_t>();
  if (extended_size < extended_header_size || extended_size + metadata_header_size + metadata_size > body.size()) {
    throw InvalidInput(say("igtl-ends-early"));
  }
  reader.raw(extended_size - 8);
  const std::size_t content_size = body.size() - extended_size - metadata_header_size - metadata_size;
  reader.raw(content_size);
  if (metadata_header_size > 0) {
    Reader names(reader.raw(metadata_header_size));
    const auto count = names.number<std::uint16_t>();
    for (int n = 0; n < count; ++n) {
      const auto key_size = names.number<std::uint16_t>();
      names.number<std::uint16_t>();  // the encoding
      const auto value_size = names.number<std::uint32_t>();
      std::string key = reader.text(key_size);
      message.metadata.emplace_back(std::move(key), reader.text(value_size));
    }
  }
  body.resize(extended_size + content_size);
  body.erase(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(extended_size));
  message.content = std::move(body);
  return message;
}

}  // namespace palpate::plugin::igtl
