#include "solver/exact/local.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::solver::internal {

namespace {

// m: nearer than this is on a primitive. It is nothing beside what any answer promises, and keeps products from
// underflowing.
constexpr double touch = 1e-50;

double reach_of(const Walk& walk, const Placed& primitive, const FineVec3& z) {
  return touch + walk.coarseness * (size_of(primitive.offset) + size_of(z));
}

// Adds the force and curvature of a plane; false where z is on it.
bool add_plane(const Walk& walk, const Placed& plane, const FineVec3& z, Local& local, Vec3& force) {
  const Depth depth = depth_of(plane, z);
  if (std::abs(depth.value) <= depth.error + reach_of(walk, plane, z)) {
    return false;
  }
  force = depth.value > 0 ? plane.direction * plane.strength : Vec3{0};
  local.size += depth.value > 0 ? plane.strength : 0;
  return true;
}

// The same of a line or point.
bool add_attractor(const Walk& walk, const Placed& attractor, const FineVec3& z, Local& local, Vec3& force) {
  const Miss miss = walk.columns != nullptr ? quick_miss_of(attractor, z) : miss_of(attractor, z);
  if (miss.length <= 4 * miss.error + reach_of(walk, attractor, z)) {
    return false;
  }
  const double s = attractor.strength;
  const Vec3 towards = miss.vector.hi() / miss.length;
  force = towards * s;
  local.size += s;
  local.noise += s * (miss.error / miss.length);
  const double curvature = s / miss.length;
  if (attractor.type == PrimitiveType::line) {
    local.hessian.add_dyad(glm::cross(attractor.direction, towards), curvature);
  } else {
    local.hessian.add_identity(curvature);
    local.hessian.add_dyad(towards, -curvature);
  }
  return true;
}

// Adds what a primitive does, or counts it among what is met.
void add(const Walk& walk, std::uint32_t i, const FineVec3& z, const ActiveSet& active, Local& local) {
  const Placed& primitive = walk.primitives[i];
  const bool off = !active.has(i) &&
                   (primitive.type == PrimitiveType::plane ? add_plane(walk, primitive, z, local, walk.forces[i])
                                                           : add_attractor(walk, primitive, z, local, walk.forces[i]));
  if (off) {
    local.gradient -= walk.forces[i];
  } else {
    walk.met[local.met++] = i;
  }
}

void look_at_many(const Walk& walk, const FineVec3& z, const ActiveSet& active, Local& local) {
  Sums sums;
  const std::size_t near = add_far(*walk.columns, z, active, walk.coarseness, touch, sums, walk.forces, walk.met);
  local.gradient -= sums.force;
  local.size += sums.size;
  // As if all roundings went one way, which those of many do not: a walk that stops there stops too early.
  constexpr double likely = 0.1;
  local.noise += likely * sums.noise;
  local.hessian.add(sums.hessian);
  for (std::size_t n = 0; n < near; ++n) {
    add(walk, walk.met[n], z, active, local);
  }
}

}  // namespace

Local evaluate(const Walk& walk, const FineVec3& z, const ActiveSet& active) {
  Local local;
  local.hessian = Symmetric3::identity(walk.stiffness);
  local.gradient = z.hi() * walk.stiffness - walk.pull;
  local.size = length_of(z.hi()) * walk.stiffness + length_of(walk.pull);
  if (walk.columns != nullptr) {
    look_at_many(walk, z, active, local);
    return local;
  }
  for (std::uint32_t i = 0; i < walk.primitives.size(); ++i) {
    if (walk.primitives[i].type != PrimitiveType::directed_force) {
      add(walk, i, z, active, local);
    }
  }
  return local;
}

double slope(const Walk& walk, const Local& local, const ActiveSet& active, const FineVec3& way) {
  double sum = glm::dot(local.gradient, way.hi());
  for (const std::uint32_t i : walk.met.first(local.met)) {
    const Placed& primitive = walk.primitives[i];
    if (active.has(i)) {
      continue;
    }
    sum += primitive.strength * (primitive.type == PrimitiveType::plane ? std::max(0.0, rate_of(primitive, way))
                                                                        : speed_across(primitive, way.hi()));
  }
  return sum;
}

double rate_of(const Placed& plane, const FineVec3& way) {
  const double rough = glm::dot(plane.direction, way.hi());
  if (std::abs(rough) > 0x1p-20 * size_of(way)) {
    return -rough;
  }
  return -dot(way, plane.given_direction).hi / plane.given_length;
}

double speed_across(const Placed& attractor, const Vec3& way) {
  const Vec3& q = attractor.direction;
  return length_of(attractor.type == PrimitiveType::line ? way - q * glm::dot(q, way) : way);
}

Vec3 newton_step(const ActiveSet& active, const Local& local, double stiffness) {
  const Symmetric3& hessian = local.hessian;
  const Vec3 wanted = -local.gradient;
  if (active.rank == 0) {
    return hessian.solve(wanted, stiffness);
  }
  if (active.rank == 2) {
    const Vec3 along = active.along.hi();
    return along * (glm::dot(along, wanted) / std::max(stiffness, glm::dot(along, hessian.times(along))));
  }
  if (active.rank == 3) {
    return Vec3{0};
  }
  const Vec3 n = active.normal[0].hi();
  const Vec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 v = glm::cross(n, u);
  const Vec3 hu = hessian.times(u);
  const double a = std::max(stiffness, glm::dot(u, hu));
  const double l = glm::dot(v, hu) / a;
  const double d = std::max(stiffness, glm::dot(v, hessian.times(v)) - l * glm::dot(v, hu));
  const double wanted_u = glm::dot(u, wanted);
  const double y = (glm::dot(v, wanted) - l * wanted_u) / d;
  return u * (wanted_u / a - l * y) + v * y;
}

}  // namespace palpate::solver::internal
