#include "solver/primitive.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palpate::solver {

namespace {

// hypot-like: offsets go down to 1e-300 m, where the plain sum of squares underflows.
Vec3 scaled_to_length(const Vec3& v, double length) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0)) {
    return Vec3{0};
  }
  const Vec3 unit = glm::normalize(v / largest);
  // Infinity times zero is not a number, but a hard constraint exerts nothing across its direction.
  const auto times_length = [length](double component) { return component == 0 ? 0 : component * length; };
  return {times_length(unit.x), times_length(unit.y), times_length(unit.z)};
}

}  // namespace

Vec3 force_on(const Primitive& primitive, const Vec3& proxy) {
  const Vec3 e = primitive.position - proxy;
  const Vec3 q = scaled_to_length(primitive.direction, 1);
  switch (primitive.type) {
    case PrimitiveType::directed_force:
      return scaled_to_length(primitive.direction, primitive.strength);
    case PrimitiveType::plane:
      return glm::dot(e, q) > 0 ? q * primitive.strength : Vec3{0};
    case PrimitiveType::line:
      return scaled_to_length(e - q * glm::dot(q, e), primitive.strength);
    case PrimitiveType::point:
      return scaled_to_length(e, primitive.strength);
  }
  return Vec3{0};
}

const char* name_of(PrimitiveType type) {
  switch (type) {
    case PrimitiveType::directed_force:
      return "force";
    case PrimitiveType::plane:
      return "plane";
    case PrimitiveType::line:
      return "line";
    case PrimitiveType::point:
      return "point";
  }
  return "unknown";
}

}  // namespace palpate::solver
