#pragma once

/// Haptic primitives: the four force functions of K. L. Palmerius, "Fast and High Precision Volume Haptics" (2007),
/// equations (2) to (6). SI units in the haptic device's frame: meters and newtons.

#include <cstdint>
#include <glm/vec3.hpp>

namespace palpate::solver {

using Vec3 = glm::dvec3;

enum class PrimitiveType : std::uint8_t { directed_force, plane, line, point };

/// One primitive, constant during a tick.
///
/// A plane pushes a proxy behind it ((position - proxy) . direction > 0) along +direction; a line and a point attract;
/// a directed force acts everywhere.
struct Primitive {
  PrimitiveType type = PrimitiveType::directed_force;
  double strength = 0;  ///< N, >= 0; infinity makes a plane, line or point a hard constraint
  Vec3 position{0};     ///< m; not read for a directed force
  Vec3 direction{0};    ///< unit vector (the solvers normalize it once more); not read for a point
};

inline Primitive make_directed_force(double strength, const Vec3& direction) {
  return {PrimitiveType::directed_force, strength, Vec3{0}, direction};
}
inline Primitive make_plane(double strength, const Vec3& position, const Vec3& direction) {
  return {PrimitiveType::plane, strength, position, direction};
}
inline Primitive make_line(double strength, const Vec3& position, const Vec3& direction) {
  return {PrimitiveType::line, strength, position, direction};
}
inline Primitive make_point(double strength, const Vec3& position) {
  return {PrimitiveType::point, strength, position, Vec3{0}};
}

/// The force of the primitive on a proxy, equations (2) to (6): N. Zero exactly on a plane, line or point.
Vec3 force_on(const Primitive& primitive, const Vec3& proxy);

/// "force", "plane", "line" or "point": the names of the command line and of scene files.
const char* name_of(PrimitiveType type);

}  // namespace palpate::solver
