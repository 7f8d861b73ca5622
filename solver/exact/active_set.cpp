#include "solver/exact/active_set.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::solver::internal {

namespace {

// About the sine of the least angle between directions that count as independent: what double-double resolves, with a
// margin.
constexpr double independent = 0x1p-80;

DoubleDouble product(double a, double b, double c, double d) {
  return two_product(a, b) + -two_product(c, d);
}

FineVec3 cross(const Vec3& a, const Vec3& b) {
  return {product(a.y, b.z, a.z, b.y), product(a.z, b.x, a.x, b.z), product(a.x, b.y, a.y, b.x)};
}

FineVec3 cross(const FineVec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

FineVec3 times(const FineVec3& a, const DoubleDouble& b) {
  return {a.x * b, a.y * b, a.z * b};
}

DoubleDouble dot(const FineVec3& a, const FineVec3& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

// Of length one but for 1e-32.
FineVec3 unit(const FineVec3& v) {
  const FineVec3 near = v * (1 / length_of(v.hi()));
  // Newton's step for 1 / sqrt.
  const DoubleDouble squared = dot(near, near);
  const DoubleDouble correction = (DoubleDouble{3, 0} - squared) * 0.5;
  return times(near, correction);
}

bool lock_plane(ActiveSet& active, std::span<const Placed> primitives, const Placed& plane) {
  if (active.rank == 3) {
    return false;
  }
  FineVec3 normal;
  if (active.rank == 0) {
    normal = unit(fine(plane.given_direction));
  } else if (active.rank == 1) {
    const Vec3& first = primitives[active.locked[0]].given_direction;
    const FineVec3 both = cross(first, plane.given_direction);
    if (!(length_of(both.hi()) > independent)) {
      return false;
    }
    active.along = unit(both);
    normal = unit(cross(both, first));
  } else {
    normal = active.along;
  }
  const double size = internal::dot(normal, plane.given_direction).hi;
  if (!(std::abs(size) > independent)) {
    return false;
  }
  active.size[active.count] = size;
  active.normal[active.count] = normal;
  active.rank += 1;
  return true;
}

}  // namespace

bool lock(ActiveSet& active, std::span<const Placed> primitives, std::uint32_t i) {
  const Placed& primitive = primitives[i];
  switch (primitive.type) {
    case PrimitiveType::directed_force:
      return false;
    case PrimitiveType::plane:
      if (!lock_plane(active, primitives, primitive)) {
        return false;
      }
      break;
    case PrimitiveType::line:
      if (active.count > 0) {
        return false;
      }
      active.along = unit(fine(primitive.given_direction));
      active.rank = 2;
      break;
    case PrimitiveType::point:
      if (active.count > 0) {
        return false;
      }
      active.rank = 3;
      break;
  }
  active.locked[active.count++] = i;
  return true;
}

ActiveSet without(const ActiveSet& active, std::span<const Placed> primitives, int j) {
  ActiveSet rest;
  for (int i = 0; i < active.count; ++i) {
    if (i != j) {
      lock(rest, primitives, active.locked[i]);
    }
  }
  return rest;
}

void settle(const ActiveSet& active, std::span<const Placed> primitives, FineVec3& z) {
  // The second pass takes away what the first one's roundings left.
  for (int pass = 0; pass < 2; ++pass) {
    for (int j = 0; j < active.count; ++j) {
      const Placed& primitive = primitives[active.locked[j]];
      if (primitive.type == PrimitiveType::point) {
        z = primitive.offset;
        return;
      }
      if (primitive.type == PrimitiveType::line) {
        const FineVec3 e = primitive.offset - z;
        z = z + (e - times(active.along, dot(e, active.along)));
      } else {
        const DoubleDouble depth = internal::dot(primitive.offset - z, primitive.given_direction);
        z = z + times(active.normal[j], depth / DoubleDouble{active.size[j], 0});
      }
    }
  }
}

double doubt_of(const ActiveSet& active, std::span<const Placed> primitives, const FineVec3& z) {
  double doubt = 0;
  for (int j = 0; j < active.count; ++j) {
    const Placed& primitive = primitives[active.locked[j]];
    if (primitive.type == PrimitiveType::plane) {
      const Depth depth = depth_of(primitive, z);
      doubt += (std::abs(depth.value) + depth.error + doubt) / std::abs(active.size[j]);
    } else {
      const Miss miss = miss_of(primitive, z);
      doubt += miss.length + miss.error;
    }
  }
  return doubt;
}

FineVec3 within(const ActiveSet& active, const FineVec3& v) {
  if (active.rank == 0) {
    return v;
  }
  if (active.rank == 1) {
    return v - times(active.normal[0], dot(v, active.normal[0]));
  }
  if (active.rank == 2) {
    return times(active.along, dot(v, active.along));
  }
  return fine(Vec3{0});
}

void share(const ActiveSet& active, std::span<const Placed> primitives, const Vec3& needed, Vec3 (&forces)[3]) {
  Vec3 rest = needed;
  // Backwards: the last normal is orthogonal to all the other planes, and to the line.
  for (int j = active.count - 1; j >= 0; --j) {
    const Placed& primitive = primitives[active.locked[j]];
    if (primitive.type == PrimitiveType::plane) {
      forces[j] =
          primitive.direction * (primitive.given_length * internal::dot(active.normal[j], rest).hi / active.size[j]);
    } else if (primitive.type == PrimitiveType::line) {
      forces[j] = rest - primitive.direction * glm::dot(primitive.direction, rest);
    } else {
      forces[j] = rest;
    }
    rest -= forces[j];
  }
}

}  // namespace palpate::solver::internal
