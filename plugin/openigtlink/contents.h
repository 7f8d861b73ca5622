#pragma once

/// The contents of the small messages: TRANSFORM, STATUS, STRING, POINT. Positions are those of the wire: RAS, mm.
/// Source: OpenIGTLink protocol (openigtlink.org/developers/spec).

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "plugin/openigtlink/bytes.h"

namespace palpate::plugin::igtl {

/// From patient space (LPS, as everywhere else) to RAS, and back.
inline glm::dvec3 ras_of(const glm::dvec3& lps) noexcept {
  return {-lps.x, -lps.y, lps.z};
}
inline glm::dvec3 lps_of(const glm::dvec3& ras) noexcept {
  return {-ras.x, -ras.y, ras.z};
}

/// TRANSFORM, 48 bytes: the columns of a rotation, then a translation, as f32.
struct Transform {
  glm::dmat3 rotation{1};
  glm::dvec3 translation{0};
};
Bytes content_of(const Transform& transform);
Transform transform_of(ByteView content);

/// STATUS, 30 bytes and a text that ends with a zero.
struct Status {
  enum class Code : std::uint16_t {
    ok = 1,
    access_denied = 5,
    overflow = 8,
    checksum_error = 9,
    configuration_error = 10,
    unknown_instruction = 12,
    not_ready = 13,
    hardware_failure = 18
  };
  Code code = Code::ok;
  std::int64_t sub_code = 0;
  std::string name;  ///< at most 20 bytes: "feeling"
  std::string text;
};
Bytes content_of(const Status& status);
Status status_of(ByteView content);

/// STRING: encoding (MIBenum; 3 is US-ASCII, 106 UTF-8), length, bytes.
inline constexpr std::size_t longest_string = 65535;
/// Uses encoding 106 if there is a character outside ASCII. Throws InvalidInput if the text is longer than
/// longest_string.
Bytes string_content(std::string_view text);
/// The text of a STRING in any encoding that extends ASCII.
std::string string_of(ByteView content);

/// POINT, 136 bytes each.
struct Point {
  std::string name;   ///< at most 64 bytes
  std::string group;  ///< at most 32 bytes
  std::array<std::uint8_t, 4> rgba{255, 255, 0, 255};
  glm::dvec3 position{0};
  double diameter = 0;
  std::string owner;  ///< at most 20 bytes: the device of the image that it belongs to
};
inline constexpr std::size_t point_size = 136;
Bytes content_of(const std::vector<Point>& points);
/// Throws InvalidInput if the size is not a multiple of a point's, or a coordinate is not a number.
std::vector<Point> points_of(ByteView content);

}  // namespace palpate::plugin::igtl
