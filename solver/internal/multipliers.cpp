#include "palpate/solver/internal/multipliers.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "palpate/solver/internal/symmetric.h"

namespace palpate::solver::internal {

Vec3 project(const Placed& primitive, const Vec3& force, Hold& hold) {
  const double s = primitive.strength;
  const Vec3& q = primitive.direction;
  if (primitive.type == PrimitiveType::plane) {
    const double t = std::max(0.0, std::min(s, glm::dot(force, q)));
    hold = t <= 0 ? Hold::idle : (t < s ? Hold::held : Hold::full);
    return q * t;
  }
  const Vec3 inside = primitive.type == PrimitiveType::line ? force - q * glm::dot(q, force) : force;
  const double size = length_of(inside);
  hold = size < s ? Hold::held : Hold::full;
  return size > s ? inside * (s / size) : inside;
}

Vec3 project(const Placed& primitive, const Vec3& force, Hold& hold, double scale, Symmetric3& derivative) {
  const double s = primitive.strength;
  const Vec3& q = primitive.direction;
  if (primitive.type == PrimitiveType::plane) {
    const Vec3 result = project(primitive, force, hold);
    if (hold == Hold::held) {
      derivative.add_dyad(q, scale);
    }
    return result;
  }
  const bool line = primitive.type == PrimitiveType::line;
  const Vec3 inside = line ? force - q * glm::dot(q, force) : force;
  const double size = length_of(inside);
  hold = size < s ? Hold::held : Hold::full;
  const double shrink = size > s ? s / size : 1;
  derivative.add_identity(scale * shrink);
  if (line) {
    derivative.add_dyad(q, -scale * shrink);
  }
  if (hold == Hold::full && size > 0) {
    derivative.add_dyad(inside / size, -scale * shrink);
  }
  return inside * shrink;
}

namespace {

// Gradient of the envelopes' sum at z and the sum of their generalised Hessians; fills next and hold.
Vec3 gradient(Multipliers& state, const Vec3& z, Symmetric3& hessian) {
  hessian = Symmetric3::identity(state.stiffness);
  Vec3 missing = state.pull - z * state.stiffness;
  for (std::size_t i = 0; i < state.primitives.size(); ++i) {
    const Placed& primitive = state.primitives[i];
    if (primitive.type != PrimitiveType::directed_force) {
      const Vec3 wanted = state.forces[i] + (primitive.offset.hi() - z) * state.sigma;
      state.next[i] = project(primitive, wanted, state.hold[i], state.sigma, hessian);
      missing += state.next[i];
    }
  }
  return -missing;
}

}  // namespace

void sweep(Multipliers& state) {
  state.z = state.pull / state.stiffness;
  for (std::size_t i = 0; i < state.primitives.size(); ++i) {
    const Placed& primitive = state.primitives[i];
    if (primitive.type != PrimitiveType::directed_force) {
      const Vec3 way = (primitive.offset.hi() - state.z) * state.stiffness;
      state.forces[i] = project(primitive, way, state.hold[i]);
      state.z += state.forces[i] / state.stiffness;
    }
  }
}

int minimise(Multipliers& state, int cap) {
  Symmetric3 hessian;
  Vec3 slope = gradient(state, state.z, hessian);
  int steps = 0;
  double force = length_of(state.pull) + length_of(state.z) * state.stiffness;
  for (const Vec3& f : state.next) {
    force += length_of(f);
  }
  while (steps < cap) {
    if (length_of(slope) <= 1e-10 * force) {
      break;
    }
    const Vec3 step = -hessian.solve(slope);
    const double start = glm::dot(slope, step);
    if (!(start < 0)) {
      break;
    }
    // The slope along the step rises monotonically: find where it is small, between what is too short and what is too
    // long.
    double shortest = 0;
    double longest = 1;
    double slope_at_shortest = start;
    double t = 1;
    Vec3 there = state.z;
    for (int tries = 0; tries < 12; ++tries) {
      there = state.z + step * t;
      slope = gradient(state, there, hessian);
      ++steps;
      const double end = glm::dot(slope, step);
      if (std::abs(end) <= -0.3 * start || (t == 1 && end < 0)) {
        break;
      }
      if (end < 0) {
        shortest = t;
        slope_at_shortest = end;
        t = 0.5 * (shortest + longest);
      } else {
        longest = t;
        t = shortest + (longest - shortest) * std::clamp(slope_at_shortest / (slope_at_shortest - end), 0.1, 0.5);
      }
    }
    if (there == state.z) {
      break;
    }
    state.z = there;
  }
  return steps;
}

}  // namespace palpate::solver::internal
