#include "solver/exact/placed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::solver::internal {

namespace {

// Of a difference and its scalar product in double-double, with a margin.
constexpr double fine_rounding = 0x1p-98;

// A difference of equal numbers is exact.
double fine_error(const FineVec3& offset, const FineVec3& z) {
  return same(offset, z) ? 0 : fine_rounding * (size_of(offset) + size_of(z));
}

}  // namespace

bool same(const FineVec3& a, const FineVec3& b) {
  return a.hi() == b.hi() && a.x.lo == b.x.lo && a.y.lo == b.y.lo && a.z.lo == b.z.lo;
}

void place(const Primitive& primitive, const Vec3& probe, Placed& placed) {
  placed.type = primitive.type;
  placed.strength = primitive.strength;
  if (primitive.type != PrimitiveType::directed_force) {
    placed.offset = exact_difference(primitive.position, probe);
  }
  if (primitive.type != PrimitiveType::point) {
    Vec3 given = primitive.direction;
    double squared = glm::dot(given, given);
    if (!(squared > 0.25 && squared < 4)) {
      // By a power of two, which is exact.
      const double largest = std::max({std::abs(given.x), std::abs(given.y), std::abs(given.z)});
      given *= std::ldexp(1.0, -std::ilogb(largest));
      squared = glm::dot(given, given);
    }
    placed.given_direction = given;
    placed.given_length = std::sqrt(squared);
    placed.direction = given / placed.given_length;
  }
}

double scaled_length_of(const Vec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest > 0 ? largest * glm::length(v / largest) : 0;
}

Miss fine_miss_of(const Placed& line_or_point, const FineVec3& z) {
  const FineVec3 e = line_or_point.offset - z;
  const double error = fine_error(line_or_point.offset, z);
  if (line_or_point.type == PrimitiveType::point) {
    return {e, length_of(e.hi()), error};
  }
  // What is along the line is taken away twice: first all but its rounding, then that.
  const Vec3& given = line_or_point.given_direction;
  const double squared = line_or_point.given_length * line_or_point.given_length;
  const double along = glm::dot(e.hi(), given) / squared;
  FineVec3 m = e - FineVec3{two_product(given.x, along), two_product(given.y, along), two_product(given.z, along)};
  m = m - fine(given * (dot(m, given).hi / squared));
  return {m, length_of(m.hi()), error};
}

Depth fine_depth_of(const Placed& plane, const FineVec3& z) {
  return {dot(plane.offset - z, plane.given_direction).hi / plane.given_length, fine_error(plane.offset, z)};
}

}  // namespace palpate::solver::internal
