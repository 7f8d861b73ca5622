#pragma once

/// The devices that Palpate names on the wire. Slicer names the nodes that it makes of them after these.

#include <string_view>

namespace palpate::plugin::igtl {

inline constexpr const char* program_name = "Palpate";  ///< STATUS
// TRANSFORM, in this order in a frame.
inline constexpr const char* stylus_name = "Stylus";
inline constexpr const char* proxy_name = "Proxy";
inline constexpr const char* force_name = "Force";              ///< its translation is in N
inline constexpr const char* velocity_name = "StylusVelocity";  ///< its translation is in mm/s
inline constexpr const char* buttons_name = "Buttons";          ///< the first column: 1 for each that is pressed
// STRING.
inline constexpr const char* scene_name = "PalpateScene";
inline constexpr const char* contact_name = "PalpateContact";
inline constexpr const char* folder_name = "PalpateFolder";
inline constexpr const char* structures_name = "PalpateStructures";
// POINT.
inline constexpr const char* marks_name = "PalpateMarks";

/// Whether a STRING of that device is something to be done.
inline bool is_request(std::string_view device) {
  return device == scene_name || device == folder_name || device == structures_name;
}

}  // namespace palpate::plugin::igtl
