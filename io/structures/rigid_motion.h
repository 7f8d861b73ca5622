#pragma once

/// A rotation and a translation from one frame of reference to another.

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "io/geometry.h"

namespace palpate::io {

struct RigidMotion {
  glm::dmat3 turn{1};  ///< a rotation
  Vec3 shift{0};       ///< mm, applied after the rotation

  Vec3 operator()(const Vec3& position_mm) const noexcept { return turn * position_mm + shift; }
  bool operator==(const RigidMotion&) const = default;
};

/// First `first`, then `second`.
inline RigidMotion after(const RigidMotion& first, const RigidMotion& second) noexcept {
  return {second.turn * first.turn, second(first.shift)};
}

inline RigidMotion back(const RigidMotion& motion) noexcept {
  const glm::dmat3 turned = glm::transpose(motion.turn);
  return {turned, -(turned * motion.shift)};
}

/// Moves the lattice with its contents.
inline void move(const RigidMotion& motion, Geometry& geometry) {
  if (motion == RigidMotion()) return;  // unchanged to the last bit
  geometry.direction_i = motion.turn * geometry.direction_i;
  geometry.direction_j = motion.turn * geometry.direction_j;
  geometry.step = motion.turn * geometry.step;
  for (Vec3& position : geometry.slice_positions) position = motion(position);
}

}  // namespace palpate::io
