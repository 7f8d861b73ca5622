#include "solver/exact/share.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "solver/exact/symmetric.h"

namespace palpate::solver::internal {

namespace {

// The same as project(), and adds its derivative to `derivative`.
Vec3 project(const Placed& primitive, const Vec3& force, ForceRegion& hold, Symmetric3& derivative) {
  const double s = primitive.strength;
  const Vec3& q = primitive.direction;
  if (primitive.type == PrimitiveType::plane) {
    const double wanted = glm::dot(force, q);
    const double t = std::max(0.0, std::min(s, wanted));
    hold = wanted <= 0 ? ForceRegion::idle : (wanted < s ? ForceRegion::held : ForceRegion::full);
    if (hold == ForceRegion::held) {
      derivative.add_dyad(q, 1);
    }
    return q * t;
  }
  const bool line = primitive.type == PrimitiveType::line;
  const Vec3 inside = line ? force - q * glm::dot(q, force) : force;
  const double size = length_of(inside);
  hold = size < s ? ForceRegion::held : ForceRegion::full;
  const double shrink = size > s ? s / size : 1;
  derivative.add_identity(shrink);
  if (line) {
    derivative.add_dyad(q, -shrink);
  }
  if (hold == ForceRegion::full && size > 0) {
    derivative.add_dyad(inside / size, -shrink);
  }
  return inside * shrink;
}

struct Sharing {
  std::span<const Placed> primitives;
  std::span<const std::uint32_t> which;
  Vec3 wanted{0};
  std::span<const Vec3> from;
  std::span<ForceRegion> hold;
  double reluctance = 0;  // what p is held back by, times p

  // What is missing with p, and minus its derivative.
  Vec3 missing(const Vec3& p, Symmetric3& derivative) const {
    derivative = Symmetric3::identity(reluctance);
    Vec3 gap = wanted - p * reluctance;
    for (const std::uint32_t i : which) {
      gap -= project(primitives[i], from[i] + p, hold[i], derivative);
    }
    return gap;
  }
};

Vec3 find_potential(const Sharing& sharing, double tolerance, Symmetric3& derivative, int& looks) {
  Vec3 p{0};
  Vec3 gap = sharing.missing(p, derivative);
  while (looks > 0 && length_of(gap) > tolerance) {
    const Vec3 step = derivative.solve(gap, sharing.reluctance);
    const double start = glm::dot(gap, step);
    if (!(start > 0)) {
      break;
    }
    // Along the step the gap falls monotonically: its root, roughly, between what is too short and what is too long.
    double shortest = 0;
    double longest = 1;
    double slope_at_shortest = start;
    double t = 1;
    Vec3 there = p;
    for (int tries = 0; tries < 12; ++tries) {
      there = p + step * t;
      --looks;
      gap = sharing.missing(there, derivative);
      const double end = glm::dot(gap, step);
      if (std::abs(end) <= 0.3 * start || (t == 1 && end > 0)) {
        break;
      }
      if (end > 0) {
        shortest = t;
        slope_at_shortest = end;
        t = 0.5 * (shortest + longest);
      } else {
        longest = t;
        t = shortest + (longest - shortest) * std::clamp(slope_at_shortest / (slope_at_shortest - end), 0.1, 0.5);
      }
    }
    if (there == p) {
      break;
    }
    p = there;
  }
  return p;
}

}  // namespace

Vec3 project(const Placed& primitive, const Vec3& force, ForceRegion& hold) {
  Symmetric3 ignored = Symmetric3::identity(0);
  return project(primitive, force, hold, ignored);
}

Vec3 share_out(std::span<const Placed> primitives, std::span<const std::uint32_t> which, const Vec3& wanted,
               double tolerance, std::span<Vec3> forces, std::span<ForceRegion> hold) {
  Sharing sharing{primitives, which, wanted, forces, hold, 1e-2};
  for (const std::uint32_t i : which) {
    forces[i] = Vec3{0};
  }
  Vec3 gap = wanted;
  int looks = 80;
  for (int round = 0; round < 6 && looks > 0; ++round) {
    const Vec3 last = gap;
    Symmetric3 derivative;
    const Vec3 p = find_potential(sharing, std::max(tolerance / 4, 1e-4 * length_of(last)), derivative, looks);
    gap = wanted;
    double size = 0;
    for (const std::uint32_t i : which) {
      forces[i] = project(primitives[i], forces[i] + p, hold[i]);
      gap -= forces[i];
      size += length_of(forces[i]);
    }
    const double left = length_of(gap);
    if (left <= tolerance + 0x1p-51 * size) {
      return Vec3{0};
    }
    // Out of reach, or only slow because bodies are nearly flat in that direction?
    const double give = glm::dot(gap, derivative.times(gap)) - sharing.reluctance * left * left;
    if (round > 0 && left > 0.5 * length_of(last) && !(give > 1e-9 * left * left)) {
      break;
    }
    sharing.reluctance *= 1e-2;
  }
  return gap;
}

}  // namespace palpate::solver::internal
