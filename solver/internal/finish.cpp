#include "palpate/solver/internal/finish.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "palpate/solver/internal/symmetric.h"

namespace palpate::solver::internal {

namespace {

// What is left of v in the directions that the flat leaves free (free = true) or fixes.
Vec3 part_of(const Flat& flat, const Vec3& v, bool free) {
  if (flat.rank == 0 || flat.rank == 3) {
    return (flat.rank == 0) == free ? v : Vec3{0};
  }
  Vec3 fixed{0};
  for (int i = 0; i < flat.rank; ++i) {
    fixed += flat.normal[i] * glm::dot(flat.normal[i], v);
  }
  return free ? v - fixed : fixed;
}

// The force that is missing at z, without those of the held primitives, and the Hessian of the others.
Vec3 missing_force(const Multipliers& state, const FineVec3& z, std::span<Vec3> forces, Symmetric3& hessian) {
  hessian = Symmetric3::identity(state.stiffness);
  FineVec3 sum = fine(state.pull) - z * state.stiffness;
  for (std::size_t i = 0; i < state.primitives.size(); ++i) {
    const Placed& primitive = state.primitives[i];
    if (primitive.type == PrimitiveType::directed_force || state.hold[i] != Hold::full) {
      continue;
    }
    if (primitive.type == PrimitiveType::plane) {
      forces[i] = primitive.direction * primitive.strength;
    } else {
      const Miss miss = miss_of(primitive, z);
      if (miss.length > 0) {
        const Vec3 along = miss.vector.hi() / miss.length;
        forces[i] = along * primitive.strength;
        const double curvature = primitive.strength / miss.length;
        hessian.add_identity(curvature);
        hessian.add_dyad(along, -curvature);
        if (primitive.type == PrimitiveType::line) {
          hessian.add_dyad(primitive.direction, -curvature);
        }
      } else {
        forces[i] = state.next[i];
      }
    }
    sum = sum + forces[i];
  }
  return sum.hi();
}

// Newton's step within the flat: the Hessian's normal part is made so stiff that nothing moves there.
Vec3 step_within(const Flat& flat, Symmetric3 hessian, const Vec3& missing, double stiffness) {
  if (flat.rank == 3) {
    return Vec3{0};
  }
  if (flat.rank == 2) {
    const Vec3 along = glm::cross(flat.normal[0], flat.normal[1]);
    return along * (glm::dot(along, missing) / glm::dot(along, hessian.times(along)));
  }
  if (flat.rank == 0) {
    return hessian.solve(missing, stiffness);
  }
  const Vec3& n = flat.normal[0];
  const Vec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 v = glm::cross(n, u);
  const Vec3 hu = hessian.times(u);
  const double a = glm::dot(u, hu);
  const double b = glm::dot(v, hu);
  const double l = b / a;
  const double d = std::max(stiffness, glm::dot(v, hessian.times(v)) - l * b);
  const double fu = glm::dot(u, missing);
  const double y = (glm::dot(v, missing) - l * fu) / d;
  return u * (fu / a - l * y) + v * y;
}

// Changes the held primitives' forces, each within its force body, until together they exert `wanted`: the least
// change, F_i <- projection of F_i + potential, with the potential from a semismooth Newton method. Ends after one step
// where the forces stay inside their bodies.
void share_out(const Multipliers& state, const Flat& flat, std::span<const std::uint32_t> held, const Vec3& wanted,
               std::span<Vec3> forces) {
  // The free directions, in which nothing is to be exerted, are filled up.
  Symmetric3 free = Symmetric3::identity(1);
  double size = length_of(wanted);
  for (int j = 0; j < flat.rank; ++j) {
    free.add_dyad(flat.normal[j], -1);
  }
  for (const std::uint32_t i : held) {
    size += length_of(forces[i]);
  }
  const auto missing = [&](const Vec3& potential, Symmetric3& derivative) {
    derivative = free;
    Vec3 gap = wanted;
    for (const std::uint32_t i : held) {
      Hold ignored;
      gap -= project(state.primitives[i], forces[i] + potential, ignored, 1, derivative);
    }
    return part_of(flat, gap, false);
  };
  Symmetric3 derivative;
  Vec3 potential{0};
  Vec3 gap = missing(potential, derivative);
  for (int steps = 0; steps < 20 && length_of(gap) > 0x1p-53 * size; ++steps) {
    const Vec3 step = derivative.solve(gap, 1e-10);
    const double start = glm::dot(gap, step);
    double t = 1;
    Vec3 there = potential;
    for (int tries = 0; tries < 8; ++tries) {
      there = potential + step * t;
      gap = missing(there, derivative);
      const double end = glm::dot(gap, step);
      if (end >= -0.1 * start) {
        break;
      }
      t *= std::clamp(start / (start - end), 0.1, 0.9);
    }
    potential = there;
  }
  for (const std::uint32_t i : held) {
    Hold ignored;
    forces[i] = project(state.primitives[i], forces[i] + potential, ignored);
  }
}

// Whether an attractor that pulls with all its strength may yet hold the proxy.
bool is_near(const Placed& primitive, const Vec3& z) {
  if (primitive.type == PrimitiveType::plane) {
    return false;
  }
  const Miss miss = miss_of(primitive, fine(z));
  return miss.length <= 1e-8 * (length_of(primitive.offset.hi()) + length_of(z));
}

}  // namespace

Settled finish(const Multipliers& state, const PlacedPrimitives& primitives, std::span<std::uint32_t> held,
               std::span<Vec3> forces) {
  std::size_t count = 0;
  bool curved = false;
  for (std::size_t i = 0; i < state.primitives.size(); ++i) {
    forces[i] = state.next[i];
    if (state.primitives[i].type == PrimitiveType::directed_force) {
      forces[i] = state.primitives[i].direction * state.primitives[i].strength;
    } else if (state.hold[i] == Hold::held || is_near(state.primitives[i], state.z)) {
      state.hold[i] = Hold::held;
      held[count++] = static_cast<std::uint32_t>(i);
    } else {
      curved = curved || state.primitives[i].type != PrimitiveType::plane;
    }
  }
  Settled settled{fine(state.z), {}};
  Symmetric3 hessian;
  Flat flat;
  Vec3 missing{0};
  double last = 0;
  for (int pass = 0; pass < 6; ++pass) {
    flat = settle(primitives, held.first(count), settled.z);
    missing = missing_force(state, settled.z, forces, hessian);
    const Vec3 step = step_within(flat, hessian, part_of(flat, missing, true), state.stiffness);
    const double length = length_of(step);
    const bool negligible = length <= 0x1p-60 * size_of(settled.z);
    if (flat.rank == 3 || negligible || (pass > 0 && length > 0.5 * last)) {
      break;
    }
    last = length;
    settled.z = settled.z + step;
  }
  if (count > 0) {
    share_out(state, flat, held.first(count), -part_of(flat, missing, false), forces);
  }
  settled.bound = bound_at(primitives, state.stiffness, settled.z, flat, forces);
  return settled;
}

}  // namespace palpate::solver::internal
