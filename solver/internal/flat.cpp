#include "palpate/solver/internal/flat.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::solver::internal {

namespace {

// Below this two directions count as parallel: what is left of their angle is left to the slack of the law.
constexpr double independent = 0x1p-44;

Vec3 without_normals(const Flat& flat, Vec3 v) {
  // Twice is enough (B. N. Parlett, The Symmetric Eigenvalue Problem, 6.9).
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < flat.rank; ++i) {
      v -= flat.normal[i] * glm::dot(flat.normal[i], v);
    }
  }
  return v;
}

// In what direction, as yet free, a primitive fixes a point: of length zero (nothing new) to one (independent).
Vec3 new_normal(const Placed& primitive, const Flat& flat) {
  const Vec3& q = primitive.direction;
  if (primitive.type == PrimitiveType::plane) {
    return without_normals(flat, q);
  }
  // A line that crosses the one direction left free fixes a point there by the part of that direction across it.
  const Vec3 left = glm::cross(flat.normal[0], flat.normal[1]);
  return left * length_of(left - q * glm::dot(q, left));
}

double needed_move(const Placed& primitive, const FineVec3& z, const Vec3& normal, double size) {
  if (primitive.type == PrimitiveType::plane) {
    return depth_of(primitive, z).value / size;
  }
  const Vec3& q = primitive.direction;
  const Vec3 across = normal - q * glm::dot(q, normal);
  return glm::dot(miss_of(primitive, z).vector.hi(), across) / (size * size);
}

double distance_to(const Placed& primitive, const FineVec3& z) {
  if (primitive.type == PrimitiveType::plane) {
    const Depth depth = depth_of(primitive, z);
    return std::abs(depth.value) + depth.error;
  }
  const Miss miss = miss_of(primitive, z);
  return miss.length + miss.error;
}

// Fixes what the first point or line in the list fixes.
bool fix_first(PrimitiveType type, const PlacedPrimitives& primitives, std::span<const std::uint32_t> held, FineVec3& z,
               Flat& flat) {
  for (const std::uint32_t i : held) {
    const Placed primitive = primitives[i];
    if (primitive.type != type) {
      continue;
    }
    flat.chosen[flat.count++] = i;
    if (type == PrimitiveType::point) {
      z = primitive.offset;
      flat.normal[0] = {1, 0, 0};
      flat.normal[1] = {0, 1, 0};
      flat.normal[2] = {0, 0, 1};
      flat.rank = 3;
    } else {
      z = z + miss_of(primitive, z).vector;
      const Vec3& q = primitive.direction;
      const Vec3 away = std::abs(q.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
      flat.normal[0] = glm::normalize(glm::cross(q, away));
      flat.normal[1] = glm::cross(q, flat.normal[0]);
      flat.rank = 2;
    }
    return true;
  }
  return false;
}

}  // namespace

bool Flat::has_chosen(std::size_t i) const {
  for (int j = 0; j < count; ++j) {
    if (chosen[j] == i) {
      return true;
    }
  }
  return false;
}

Flat settle(const PlacedPrimitives& primitives, std::span<const std::uint32_t> held, FineVec3& z) {
  Flat flat;
  if (fix_first(PrimitiveType::point, primitives, held, z, flat)) {
    return flat;
  }
  fix_first(PrimitiveType::line, primitives, held, z, flat);
  double sizes[3] = {1, 1, 1};
  while (flat.rank < 3) {
    double best_size = independent;
    Vec3 best{0};
    std::uint32_t best_index = 0;
    for (const std::uint32_t i : held) {
      const Placed primitive = primitives[i];
      if (primitive.type == PrimitiveType::plane || (primitive.type == PrimitiveType::line && flat.rank == 2)) {
        const Vec3 normal = new_normal(primitive, flat);
        const double size = length_of(normal);
        if (size > best_size) {
          best_size = size;
          best = normal / size;
          best_index = i;
        }
      }
    }
    if (best_size == independent) {
      break;
    }
    z = z + best * needed_move(primitives[best_index], z, best, best_size);
    sizes[flat.count] = best_size;
    flat.chosen[flat.count++] = best_index;
    flat.normal[flat.rank++] = best;
  }

  if (flat.rank == 3) {
    // Primitives of one position meet there and nowhere else.
    const FineVec3 first = primitives[flat.chosen[0]].offset;
    bool one_position = true;
    for (int j = 1; j < flat.count; ++j) {
      one_position = one_position && same(first, primitives[flat.chosen[j]].offset);
    }
    if (one_position) {
      z = first;
      return flat;
    }
  }
  // Forward substitution: the rows are independent, with `sizes` on the diagonal and at most one beside it. (Two lines
  // that miss each other have no common point; their distance then stays in the slack of the second.)
  for (int j = 0; j < flat.count; ++j) {
    const Placed primitive = primitives[flat.chosen[j]];
    if (primitive.type == PrimitiveType::line && j > 0) {
      --flat.count;
      break;
    }
    flat.doubt += (distance_to(primitive, z) + flat.doubt) / sizes[j];
  }
  return flat;
}

}  // namespace palpate::solver::internal
