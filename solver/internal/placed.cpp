#include "palpate/solver/internal/placed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::solver::internal {

namespace {

// Of a double-double dot product of three terms, with an ample margin over 2^-102 for each operation.
constexpr double fine_rounding = 0x1p-98;

// A difference of equal numbers is exact.
double error_of(const FineVec3& offset, const FineVec3& z) {
  return offset.hi == z.hi && offset.lo == z.lo ? 0 : fine_rounding * (size_of(offset) + size_of(z));
}

}  // namespace

double size_of(const FineVec3& v) {
  return std::abs(v.hi.x) + std::abs(v.hi.y) + std::abs(v.hi.z);
}

Placed place(const Primitive& primitive, const Vec3& probe) {
  Placed placed{primitive.type, primitive.strength, {}, {}};
  if (primitive.type != PrimitiveType::directed_force) {
    placed.offset = exact_difference(primitive.position, probe);
  }
  if (primitive.type != PrimitiveType::point) {
    const FineVec3 direction{primitive.direction, Vec3{0}};
    placed.direction = direction * inverse_sqrt(dot(direction, direction));
  }
  return placed;
}

double length_of(const Vec3& v) {
  const double squared = glm::dot(v, v);
  if (squared > 1e-280 && squared < 1e280) {
    return std::sqrt(squared);
  }
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest > 0 ? largest * glm::length(v / largest) : 0;
}

Miss miss_of(const Placed& line_or_point, const FineVec3& z) {
  FineVec3 m = line_or_point.offset - z;
  if (line_or_point.type == PrimitiveType::line) {
    m = m - line_or_point.direction * dot(line_or_point.direction, m);
  }
  return {m, length_of(m.hi), error_of(line_or_point.offset, z)};
}

Depth depth_of(const Placed& plane, const FineVec3& z) {
  return {dot(plane.offset - z, plane.direction).hi, error_of(plane.offset, z)};
}

}  // namespace palpate::solver::internal
