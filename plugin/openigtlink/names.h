#pragma once

/// The device names that Palpate uses on the wire. Slicer names its nodes after them.

#include <string_view>

namespace palpate::plugin::igtl {

inline constexpr const char* program_name = "Palpate";  ///< STATUS
// TRANSFORM, in this order in a frame.
inline constexpr const char* stylus_name = "Stylus";
inline constexpr const char* proxy_name = "Proxy";
inline constexpr const char* force_name = "Force";              ///< its translation is in N
inline constexpr const char* velocity_name = "StylusVelocity";  ///< its translation is in mm/s
inline constexpr const char* buttons_name = "Buttons";          ///< the first column: 1 for each pressed button
// STRING.
inline constexpr const char* scene_name = "PalpateScene";
inline constexpr const char* contact_name = "PalpateContact";
inline constexpr const char* folder_name = "PalpateFolder";
inline constexpr const char* structures_name = "PalpateStructures";
// POINT.
inline constexpr const char* marks_name = "PalpateMarks";

/// Whether a STRING with that device name is a request.
inline bool is_request(std::string_view device) {
  return device == scene_name || device == folder_name || device == structures_name;
}

}  // namespace palpate::plugin::igtl
