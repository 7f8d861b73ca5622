#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "device/stylus.h"

namespace palpate::device {

inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The vector, shortened to the length `longest` (>= 0) if it is longer. Rounding never makes it longer than that.
inline Vec3 clamp_length(const Vec3& v, double longest) {
  // Scaled first: the square of a huge component overflows, and inf / inf would turn it into a NaN.
  const double largest = std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  if (!(largest > 0)) return Vec3(0);
  const Vec3 scaled = v / largest;
  const double length = glm::length(scaled);
  if (length * largest <= longest) return v;
  Vec3 clamped = scaled * (longest / length);
  if (glm::length(clamped) > longest) clamped *= 1 - 4e-16;
  return clamped;
}

}  // namespace palpate::device
