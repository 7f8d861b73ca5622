#pragma once

/// A message of OpenIGTLink: a header of 58 bytes and a body. Source: OpenIGTLink protocol, versions 1 to 3
/// (openigtlink.org/developers/spec), "Header". All numbers are big-endian.
///
/// Palpate writes version 1, which every client can read. It also reads version 2, in which the body has an extended
/// header before the content and metadata after it.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plugin/openigtlink/bytes.h"

namespace palpate::plugin::igtl {

inline constexpr std::size_t header_size = 58;
inline constexpr std::size_t type_size = 12, device_size = 20;

struct Header {
  std::uint16_t version = 1;
  std::string type;    ///< "TRANSFORM"; at most 12 bytes
  std::string device;  ///< at most 20 bytes
  double time_s = 0;   ///< since 1970, UTC; on the wire 32.32 bits
  std::uint64_t body_size = 0;
  std::uint64_t checksum = 0;  ///< of the body
};

struct Message {
  std::string type;
  std::string device;
  double time_s = 0;
  Bytes content;                                                   ///< the body without extended header and metadata
  std::vector<std::pair<std::string, std::string>> metadata = {};  ///< of version 2
};

/// CRC-64 of ECMA-182: polynomial 42F0E1EBA9EA3693, initial value 0, neither reflected nor inverted. `before`: the
/// checksum of preceding bytes.
std::uint64_t checksum(ByteView bytes, std::uint64_t before = 0) noexcept;

/// Appends the message in the form of the wire.
void append(Bytes& wire, const Message& message, std::uint16_t version = 1);

/// Throws InvalidInput if the bytes are no header.
Header read_header(ByteView bytes);
/// The message of a header and a body with the right checksum. Throws InvalidInput if its parts do not fit into it.
Message read_message(const Header& header, Bytes body);

}  // namespace palpate::plugin::igtl
