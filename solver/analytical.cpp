#include "solver/analytical.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "solver/certify.h"
#include "solver/exact/answer.h"

namespace palpate::solver {

namespace {

using internal::length_of;
using internal::Placed;
using internal::PlacedPrimitives;

// Primitives that act as one.
struct Group {
  PrimitiveType type;
  double strength;
  int hard_members;
  Vec3 offset;
  Vec3 direction;
  Vec3 force;
};

struct Groups {
  std::array<Group, 16> group;
  std::size_t count = 0;

  std::span<Group> all() { return std::span(group).first(count); }
};

// What merges is what rounding of the data may have set apart. The certificate judges the result, so this decides only
// how the force is shared.
bool coincide(const Placed& primitive, const Group& group) {
  if (primitive.type != group.type) {
    return false;
  }
  constexpr double rounding = 0x1p-50;
  const Vec3 offset = primitive.offset.hi();
  const Vec3 apart = offset - group.offset;
  const Vec3& q = group.direction;
  const auto near = [&] { return rounding * (length_of(offset) + length_of(group.offset)); };
  const auto parallel = [&] { return length_of(glm::cross(primitive.direction, q)) <= rounding; };
  switch (primitive.type) {
    case PrimitiveType::plane:
      return parallel() && glm::dot(primitive.direction, q) > 0 && std::abs(glm::dot(apart, q)) <= near();
    case PrimitiveType::line:
      return parallel() && length_of(apart - q * glm::dot(q, apart)) <= near();
    case PrimitiveType::point:
      return length_of(apart) <= near();
    case PrimitiveType::directed_force:
      break;
  }
  return false;
}

// The first group that it is of, or their count.
std::size_t find_group(const Placed& primitive, const Groups& groups) {
  std::size_t n = 0;
  while (n < groups.count && !coincide(primitive, groups.group[n])) {
    ++n;
  }
  return n;
}

// The group that it is of from now on; null where there is no room for another.
const Group* add_to_groups(const Placed& primitive, Groups& groups) {
  const int hard = std::isinf(primitive.strength) ? 1 : 0;
  const std::size_t n = find_group(primitive, groups);
  if (n == groups.group.size()) {
    return nullptr;
  }
  Group& group = groups.group[n];
  if (n == groups.count) {
    group = {primitive.type, primitive.strength, hard, primitive.offset.hi(), primitive.direction, Vec3{0}};
    ++groups.count;
  } else {
    group.strength += primitive.strength;
    group.hard_members += hard;
  }
  return &group;
}

// Moves z towards the group's constraint, but never past it, equations (13) to (16).
void move(Group& group, double stiffness, Vec3& z) {
  Vec3 way = group.offset - z;
  const Vec3& q = group.direction;
  if (group.type == PrimitiveType::plane) {
    way = q * std::max(0.0, glm::dot(way, q));
  } else if (group.type == PrimitiveType::line) {
    way -= q * glm::dot(way, q);
  }
  const double distance = length_of(way);
  const double reach = group.strength / stiffness;
  const Vec3 step = distance > reach ? way * (reach / distance) : way;
  group.force = step * stiffness;
  z += step;
}

// The member's part of the group's force, along its own direction: members agree in it but for rounding.
Vec3 part_of(const Placed& member, const Group& group) {
  double fraction = 0;
  if (group.hard_members > 0) {
    fraction = std::isinf(member.strength) ? 1.0 / group.hard_members : 0;
  } else if (group.strength > 0) {
    fraction = member.strength / group.strength;
  }
  return group.force * fraction;
}

}  // namespace

Solution solve_analytical(const Balance& balance, std::span<Vec3> forces) noexcept {
  Solution solution;
  solution.solver = &analytical_solver;
  const std::size_t n = balance.primitives.size();
  std::array<Placed, 16> few;
  std::array<const Group*, few.size()> group_of;  // of the few
  const bool stored = n > 0 && n <= few.size();
  for (std::size_t i = 0; stored && i < n; ++i) {
    internal::place(balance.primitives[i], balance.probe, few[i]);
  }
  const PlacedPrimitives primitives =
      stored ? PlacedPrimitives(std::span(few).first(n)) : PlacedPrimitives(balance.primitives, balance.probe);

  Vec3 z{0};
  Placed room;
  Groups groups;
  for (std::size_t i = 0; i < n; ++i) {
    const Placed& primitive = primitives.at(i, room);
    forces[i] = Vec3{0};
    if (primitive.type == PrimitiveType::directed_force) {
      forces[i] = primitive.direction * primitive.strength;
      z += forces[i] / balance.stiffness;
    } else if (primitive.strength > 0) {
      const Group* const group = add_to_groups(primitive, groups);
      if (group == nullptr) {
        return solution;
      }
      if (stored) {
        group_of[i] = group;
      }
    }
  }
  for (const PrimitiveType type : {PrimitiveType::plane, PrimitiveType::line, PrimitiveType::point}) {
    for (Group& group : groups.all()) {
      if (group.type == type) {
        move(group, balance.stiffness, z);
        ++solution.iterations;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Placed& primitive = primitives.at(i, room);
    if (primitive.type != PrimitiveType::directed_force && primitive.strength > 0) {
      forces[i] = part_of(primitive, stored ? *group_of[i] : groups.group[find_group(primitive, groups)]);
    }
  }

  const internal::Settled settled =
      internal::settle_and_bound(primitives, balance.stiffness, internal::fine(z), forces);
  internal::write_answer(balance, settled, solution);
  if (settled.bound.backward_error <= promised_accuracy(balance, solution.proxy, forces)) {
    solution.outcome = Outcome::solved;
  }
  return solution;
}

const SolverType analytical_solver{
    .name = "analytical",
    .number = 1,
    .summary = "one pass of movements: exact if no movement disturbs another, as in section 3.1",
    .solves = Solves::section_3_1,
    .is_usual = true,
    .solve = [](const Balance& balance, std::span<Vec3> forces, Scratch*, const RunOptions&) noexcept {
      return solve_analytical(balance, forces);
    }};

}  // namespace palpate::solver
