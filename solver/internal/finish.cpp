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

// Between sticking and slipping, where friction rests for as long as the probe does, one attractor among the held pulls
// with all its strength, within rounding, in the directions that the others leave free. There the forces are one point
// of the force bodies, which share_out() approaches slowly; here they are known.
bool let_slip(const Multipliers& state, const PlacedPrimitives& primitives, std::span<std::uint32_t> held,
              const Vec3& wanted, std::span<Vec3> forces, Settled& slipped) {
  const auto slips = std::find_if(held.begin(), held.end(), [&](std::uint32_t i) {
    const Placed& primitive = state.primitives[i];
    return primitive.type != PrimitiveType::plane && length_of(forces[i]) >= primitive.strength * (1 - 0x1p-30);
  });
  if (slips == held.end()) {
    return false;
  }
  std::iter_swap(slips, held.end() - 1);
  const std::span<std::uint32_t> others = held.first(held.size() - 1);
  const Placed& attractor = state.primitives[held.back()];
  FineVec3 z = fine(state.z);
  const Flat rest = settle(primitives, others, z);
  Vec3 pull = part_of(rest, wanted, true);
  if (attractor.type == PrimitiveType::line) {
    pull -= attractor.direction * glm::dot(attractor.direction, pull);
  }
  const double size = length_of(pull);
  if (!(std::abs(size - attractor.strength) <= 0x1p-30 * size)) {
    return false;
  }
  forces[held.back()] = pull * (attractor.strength / size);
  share_out(state, rest, others, part_of(rest, wanted - forces[held.back()], false), forces);
  Vec3 sum = state.pull;
  for (std::size_t i = 0; i < state.primitives.size(); ++i) {
    sum += state.primitives[i].type == PrimitiveType::directed_force ? Vec3{0} : forces[i];
  }
  slipped = settle_and_bound(primitives, state.stiffness, fine(sum / state.stiffness), forces);
  return true;
}

}  // namespace

Settled finish(const Multipliers& state, const PlacedPrimitives& primitives, std::span<std::uint32_t> held,
               std::span<Vec3> forces) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < state.primitives.size(); ++i) {
    forces[i] = state.next[i];
    if (state.primitives[i].type == PrimitiveType::directed_force) {
      forces[i] = state.primitives[i].direction * state.primitives[i].strength;
    } else if (state.hold[i] == Hold::held || is_near(state.primitives[i], state.z)) {
      state.hold[i] = Hold::held;
      held[count++] = static_cast<std::uint32_t>(i);
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
  Settled slipped;
  if (settled.bound.backward_error > 0x1p-50 * size_of(settled.z) &&
      let_slip(state, primitives, held.first(count), -missing, forces, slipped)) {
    if (slipped.bound.backward_error < settled.bound.backward_error) {
      return slipped;
    }
    share_out(state, flat, held.first(count), -part_of(flat, missing, false), forces);
    settled.bound = bound_at(primitives, state.stiffness, settled.z, flat, forces);
  }
  return settled;
}

}  // namespace palpate::solver::internal
