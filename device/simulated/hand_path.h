#pragma once

/// The target of a scripted hand, over time.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "device/stylus.h"

namespace palpate::device {

struct Waypoint {
  double time = 0;            ///< s since the stylus was opened
  Vec3 position{0};           ///< m, device frame
  std::uint32_t buttons = 0;  ///< held from this waypoint to the next
};

enum class PathInterpolation : std::uint8_t {
  linear,
  minimum_jerk,  ///< from rest to rest: T. Flash and N. Hogan, J. Neuroscience 5(7), 1985; 10 s^3 - 15 s^4 + 6 s^5
};

/// Throws std::invalid_argument naming the waypoint: there is none, one is not finite, or times do not increase.
void check_path(std::span<const Waypoint> path);

/// The path at a time; the first waypoint before it, the last one after it. For checked paths only.
Waypoint point_on(std::span<const Waypoint> path, PathInterpolation interpolation, double time) noexcept;

}  // namespace palpate::device
