#include "solver/exact/bound.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "solver/certify.h"

namespace palpate::solver::internal {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Keeps bounds above zero where products of tiny numbers underflow.
constexpr double underflow_margin = 1e-150;

// How far 4 ulp of a primitive's position and direction may move it near z.
double rounding_of_data(const Placed& primitive, const FineVec3& z) {
  return 8 * unit_roundoff * (size_of(primitive.offset) + size_of(z));
}

// How far a hard constraint may be missed, where that is asked for.
double leeway(const Placed& primitive, const FineVec3& z, bool leniently) {
  return leniently ? hard_tolerance * (size_of(primitive.offset) + size_of(z)) : 0;
}

Contribution share_of_plane(const Placed& plane, const FineVec3& z, const Vec3& force, double stiffness, double doubt,
                            bool leniently) {
  const double s = plane.strength;
  Depth depth = depth_of(plane, z);
  depth.error += doubt;
  const double given = std::max(0.0, std::min(s, glm::dot(force, plane.direction)));
  const auto slack_within = [&](double tolerance) {
    const double behind = std::max(0.0, depth.value + depth.error - tolerance);
    const double before = std::max(0.0, depth.error - depth.value - tolerance);
    const bool met = depth.value <= depth.error + tolerance + leeway(plane, z, leniently);
    return (std::isinf(s) ? (met ? 0 : infinity) : (s - given) * behind) + given * before;
  };
  const double slack = slack_within(0);
  const double full = depth.value > 0 ? s : 0;
  if (std::abs(depth.value) > depth.error && std::isfinite(full)) {
    const double change = full - given;
    if (change * change <= stiffness * slack) {
      return {plane.direction * full, 4 * unit_roundoff * full, 0, 0, false};
    }
  }
  const double backward = slack > 0 ? slack_within(rounding_of_data(plane, z)) : 0;
  return {plane.direction * given, 4 * unit_roundoff * given, slack, backward, slack > 0};
}

struct Given {
  Vec3 force;
  double size;
};

// What a line or point gives of a force (newtons): the part that it can, at most its strength.
Given given_by_attractor(const Placed& attractor, const Vec3& force) {
  const double s = attractor.strength;
  const Vec3& q = attractor.direction;
  const Vec3 wanted = attractor.type == PrimitiveType::line ? force - q * glm::dot(q, force) : force;
  const double size = length_of(wanted);
  if (size > s) return {s > 0 ? wanted * (s / size) : Vec3{0}, s};
  return {wanted, size};
}

Contribution share_of_attractor(const Placed& attractor, const FineVec3& z, const Vec3& force, double stiffness,
                                double doubt, bool leniently) {
  const double s = attractor.strength;
  const bool hard = std::isinf(s);
  Miss miss = miss_of(attractor, z);
  miss.error += doubt;
  const auto [given, size] = given_by_attractor(attractor, force);
  const double reach = hard ? size : s + size;
  const double rounding = 8 * unit_roundoff * reach * miss.length + 2 * reach * miss.error;
  const double off =
      hard ? (miss.length <= 4 * miss.error + leeway(attractor, z, leniently) ? 0 : infinity) : s * miss.length;
  double slack = std::max(0.0, off - glm::dot(given, miss.vector.hi())) + rounding;
  if (miss.length > 4 * miss.error && !hard) {
    const Vec3 full = miss.vector.hi() * (s / miss.length);
    const double turn = 2 * s * miss.error / miss.length;
    const double change = length_of(full - given) + turn;
    if (size >= s * (1 - 8 * unit_roundoff)) {
      // Of full size but for rounding, which the force's error covers: only its direction can miss, and
      // s |m| - F.m = |m| |s m/|m| - F|^2 / (2 s) has no cancellation. It counts where friction is about to slip.
      const double miss_of_direction = change + 16 * unit_roundoff * s;
      slack = std::min(slack, (miss.length + miss.error) * miss_of_direction * miss_of_direction / (2 * s));
    }
    if (change * change <= stiffness * slack) {
      return {full, 8 * unit_roundoff * s + turn, 0, 0, false};
    }
  }
  const double near = rounding_of_data(attractor, z);
  const double backward = miss.length <= near ? 0 : slack;
  const bool on = size < s * (1 - 8 * unit_roundoff) || miss.length <= 4 * near;
  return {given, 16 * unit_roundoff * size, slack, backward, slack > 0 && on};
}

}  // namespace

Contribution share_of(const Placed& primitive, const FineVec3& z, const Vec3& force, double stiffness, double doubt,
                      bool leniently) {
  switch (primitive.type) {
    case PrimitiveType::directed_force:
      return {primitive.direction * primitive.strength, 4 * unit_roundoff * primitive.strength, 0, 0, false};
    case PrimitiveType::plane:
      return share_of_plane(primitive, z, force, stiffness, doubt, leniently);
    case PrimitiveType::line:
    case PrimitiveType::point:
      return share_of_attractor(primitive, z, force, stiffness, doubt, leniently);
  }
  return {};
}

namespace {

// share_of() where z is the primitive's own position: on it, without any doubt, there is no slack.
Contribution share_of_met(const Placed& primitive, const Vec3& force) {
  const double s = primitive.strength;
  if (primitive.type == PrimitiveType::plane) {
    const double given = std::max(0.0, std::min(s, glm::dot(force, primitive.direction)));
    return {primitive.direction * given, 4 * unit_roundoff * given, 0, 0, false};
  }
  const auto [given, size] = given_by_attractor(primitive, force);
  return {given, 16 * unit_roundoff * size, 0, 0, false};
}

// The law, as one primitive after the other is added to it.
struct Law {
  FineVec3 sum;
  double rounding;
  double slack = 0;
  double backward_slack = 0;

  void add(const Contribution& share) {
    sum = sum + -share.force;
    rounding += share.force_error;
    slack += share.slack;
    backward_slack += share.backward_slack;
  }
  Bound bound(std::size_t primitives, double stiffness, double doubt) const;
};

Bound Law::bound(std::size_t primitives, double stiffness, double doubt) const {
  Bound bound;
  bound.slack = slack;
  const double outwards = 1 + 16 * unit_roundoff + 2 * unit_roundoff * static_cast<double>(primitives);
  bound.residual = (length_of(sum.hi()) + rounding) * outwards;
  const auto law = [&](double slack_then) {
    const double r = bound.residual / stiffness;
    const double error = (r + std::sqrt(r * r + 4 * slack_then * outwards / stiffness)) / 2 + doubt;
    return error < infinity ? error * outwards + underflow_margin : infinity;
  };
  bound.error = law(slack);
  bound.backward_error = slack > 0 ? law(backward_slack) : bound.error;
  return bound;
}

}  // namespace

Bound bound_at(const PlacedPrimitives& primitives, double stiffness, const FineVec3& z, const Flat& flat,
               std::span<const Vec3> forces, bool leniently) {
  Law law{.sum = z * stiffness, .rounding = stiffness * flat.doubt};
  Placed room;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    // On the exact flat its own primitives have no slack: only their force bodies are asked.
    law.add(flat.has(i) ? share_of_met(primitives.at(i, room), forces[i])
                        : share_of(primitives.at(i, room), z, forces[i], stiffness, flat.doubt, leniently));
  }
  return law.bound(primitives.size(), stiffness, flat.doubt);
}

Bound bound_of(std::span<const Contribution> shares, double stiffness, const FineVec3& z) {
  Law law{.sum = z * stiffness, .rounding = 0};
  for (const Contribution& share : shares) {
    law.add(share);
  }
  return law.bound(shares.size(), stiffness, 0);
}

}  // namespace palpate::solver::internal
