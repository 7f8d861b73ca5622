#include "solver/exact/columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "solver/exact/local.h"
#include "solver/testing/problems.h"

namespace palpate::solver::internal {
namespace {

/// Many primitives of all kinds, or of those that are kept, sorted by kind, and a walk over them.
struct Crowd {
  using Kept = bool(PrimitiveType);
  Crowd(
      std::uint64_t seed, std::size_t count, Kept kept = [](PrimitiveType) { return true; }) {
    Problem problem = make_problem(Family::many, seed, count);
    std::erase_if(problem.primitives, [&](const Primitive& primitive) { return !kept(primitive.type); });
    count = problem.primitives.size();
    std::ranges::sort(problem.primitives, {}, &Primitive::type);
    for (const Primitive& primitive : problem.primitives) place(primitive, problem.probe, placed.emplace_back());
    std::ranges::sort(placed, {}, &Placed::type);
    columns.fit(count);
    columns.take(placed);
    forces.resize(count);
    hold.resize(count);
    met.resize(count);
    walk.primitives = placed;
    walk.stiffness = problem.stiffness;
    walk.coarseness = 0x1p-51;
    walk.forces = forces;
    walk.hold = hold;
    walk.met = met;
  }

  /// What is looked at side by side, or one after the other; returned with the forces and what is met.
  struct Seen {
    Local local;
    std::vector<Vec3> forces;
    std::vector<std::uint32_t> met;
  };
  Seen look_at(const FineVec3& z, bool side_by_side) {
    std::ranges::fill(forces, Vec3{7});  // of what is met nothing is written
    walk.columns = side_by_side ? &columns : nullptr;
    const Local local = evaluate(walk, z, walk.active);
    std::vector<std::uint32_t> all(met.begin(), met.begin() + static_cast<std::ptrdiff_t>(local.met));
    for (const std::uint32_t i : all) forces[i] = Vec3{0};
    return {local, forces, all};
  }

  std::vector<Placed> placed;
  Columns columns;
  std::vector<Vec3> forces;
  std::vector<ForceRegion> hold;
  std::vector<std::uint32_t> met;
  Walk walk;
};

void expect_the_same(Crowd& crowd, const FineVec3& z) {
  const Crowd::Seen apart = crowd.look_at(z, false);
  const Crowd::Seen together = crowd.look_at(z, true);
  const double size = apart.local.size;
  EXPECT_EQ(together.met, apart.met);
  EXPECT_NEAR(together.local.size, size, 1e-13 * size);
  EXPECT_LT(glm::length(together.local.gradient - apart.local.gradient), 1e-13 * size);
  const Symmetric3 &a = apart.local.hessian, &b = together.local.hessian;
  const double most = a.xx + a.yy + a.zz;
  for (const double difference : {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz}) {
    EXPECT_LT(std::abs(difference), 1e-11 * most);
  }
  for (std::size_t i = 0; i < crowd.placed.size(); ++i) {
    if (crowd.placed[i].type == PrimitiveType::directed_force) continue;
    EXPECT_LT(glm::length(together.forces[i] - apart.forces[i]), 1e-13 * crowd.placed[i].strength) << i;
  }
}

TEST(Columns, SideBySideIsAsOneAfterTheOther) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Crowd crowd(seed, 65 + 7 * seed);
    Random random(seed);
    for (int n = 0; n < 10; ++n) expect_the_same(crowd, fine(random.normal_vector(2e-3)));
  }
}

TEST(Columns, KindsMayBeMissing) {
  using Type = PrimitiveType;
  constexpr Crowd::Kept* some[] = {
      [](Type type) { return type == Type::point; },
      [](Type type) { return type == Type::line; },
      [](Type type) { return type == Type::plane; },
      [](Type type) { return type == Type::plane || type == Type::point; },
      [](Type type) { return type == Type::line || type == Type::directed_force; },
      [](Type type) { return type == Type::plane || type == Type::directed_force; },
  };
  for (Crowd::Kept* const kept : some) {
    Crowd crowd(5, 400, kept);
    ASSERT_GT(crowd.placed.size(), 50);
    Random random(5);
    for (int n = 0; n < 10; ++n) expect_the_same(crowd, fine(random.normal_vector(2e-3)));
  }
}

TEST(Columns, WhatIsMetAndWhatIsLockedIsLeftOut) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Crowd crowd(seed, 200);
    for (std::uint32_t i = 0; i < crowd.placed.size(); i += 3) {
      if (crowd.placed[i].type == PrimitiveType::directed_force) continue;
      expect_the_same(crowd, crowd.placed[i].offset);
      // What is locked counts as met, though z may be elsewhere.
      ASSERT_TRUE(internal::lock(crowd.walk.active, crowd.placed, i));
      expect_the_same(crowd, fine(Random(seed).normal_vector(2e-3)));
      crowd.walk.active = {};
    }
  }
}

/// What add_far() does with these, sorted by kind, where nothing is locked.
struct Far {
  Sums sums;
  std::vector<Vec3> forces;
  std::vector<std::uint32_t> near;

  Far(const std::vector<Placed>& placed, const FineVec3& z, double coarseness, double touch)
      : forces(placed.size()), near(placed.size() + 1) {
    Columns columns;
    columns.fit(placed.size());
    columns.take(placed);
    near.resize(add_far(columns, z, {}, coarseness, touch, sums, forces, near));
  }
};

Placed placed_at(PrimitiveType type, const Vec3& offset, const Vec3& direction = Vec3{0}) {
  return {.type = type, .strength = 2, .offset = fine(offset), .direction = direction};
}

/// Where the leading doubles of z and of a position are the same, what is behind them tells the way.
TEST(Columns, TheLastDigitsOfAPlaceCount) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const Vec3 place = random.normal_vector(1e-2);
    const Vec3 own = random.normal_vector(1e-19), of_z = random.normal_vector(1e-19), q = random.unit_vector();
    const Vec3 miss = own - of_z, across = miss - q * glm::dot(q, miss);
    if (glm::length(across) < 0.5 * glm::length(miss)) continue;
    FineVec3 z = fine(place);
    z.x.lo = of_z.x, z.y.lo = of_z.y, z.z.lo = of_z.z;
    for (const auto& [type, way] : {std::pair(PrimitiveType::line, across), std::pair(PrimitiveType::point, miss)}) {
      std::vector<Placed> one{placed_at(type, place, q)};
      one[0].offset.x.lo = own.x, one[0].offset.y.lo = own.y, one[0].offset.z.lo = own.z;
      const Far far(one, z, 0, 0);
      ASSERT_TRUE(far.near.empty());
      EXPECT_LT(glm::length(far.forces[0] - 2.0 * glm::normalize(way)), 1e-12) << n;
    }
  }
}

/// Side by side is what lies farther from z than may be wrong, than what counts as met, and as far as its own place
/// asks for: each by the rule of its kind. What is wrong of the sum is what is wrong of each.
TEST(Columns, WhatIsFarEnoughIsLookedAtSideBySide) {
  Random random(4);
  std::size_t near = 0, all = 0;
  for (int n = 0; n < 300; ++n) {
    const double touch = random.log_uniform(1e-6, 1e-2), coarseness = random.log_uniform(1e-4, 0.3);
    const Vec3 z = random.normal_vector(1e-2);
    std::vector<Placed> placed;
    for (const PrimitiveType type : {PrimitiveType::plane, PrimitiveType::line, PrimitiveType::point}) {
      for (int k = 0; k < 30; ++k) {
        placed.push_back(placed_at(type, random.normal_vector(1e-2), random.unit_vector()));
        if (type == PrimitiveType::point) placed.back().direction = Vec3{0};
      }
    }
    const Far far(placed, fine(z), coarseness, touch);
    std::vector<std::uint32_t> expected;
    double noise = 0;
    bool is_close_call = false;
    for (std::uint32_t i = 0; i < placed.size(); ++i) {
      const Placed& one = placed[i];
      const Vec3 e = one.offset.hi() - z, q = one.direction;
      const double size = size_of(one.offset) + size_of(fine(z));
      const double distance = std::abs(e.x) + std::abs(e.y) + std::abs(e.z);
      const double length =
          one.type == PrimitiveType::plane ? std::abs(glm::dot(q, e)) : glm::length(e - q * glm::dot(q, e));
      const double least = one.type == PrimitiveType::plane
                               ? std::max(0x1p-30 * size, 0x1p-50 * size + touch + coarseness * size)
                               : std::max(0.25 * distance, 0x1p-47 * distance + touch + coarseness * size);
      is_close_call = is_close_call || std::abs(length - least) < 1e-9 * size;
      if (length <= least) {
        expected.push_back(i);
      } else if (one.type != PrimitiveType::plane) {
        noise += 0x1p-49 * distance * one.strength / length;
      }
    }
    if (is_close_call) continue;
    EXPECT_EQ(far.near, expected);
    EXPECT_NEAR(far.sums.noise, noise, 1e-9 * noise);
    near += expected.size();
    all += placed.size();
  }
  EXPECT_GT(near, all / 20);
  EXPECT_LT(near, all / 2);
}

/// Lengths in another unit, a power of two times as large, leave the same primitives near: also where rounding alone
/// decides.
TEST(Columns, WhatIsNearDoesNotDependOnTheUnit) {
  Random random(11);
  std::size_t near = 0, all = 0;
  for (int n = 0; n < 100; ++n) {
    const Vec3 z = random.normal_vector(1);
    std::vector<Placed> placed;
    for (int i = 0; i < 24; ++i) {
      const Vec3 q = random.unit_vector(), apart = random.normal_vector(1);
      const double depth = 0x1p-30 * glm::length(z) * random.uniform(-8, 8);
      placed.push_back(placed_at(PrimitiveType::plane, z + apart - q * (glm::dot(apart, q) - depth), q));
    }
    const Far far(placed, fine(z), 0, 0);
    for (const double unit : {0x1p-20, 0x1p-3, 0x1p20}) {
      std::vector<Placed> scaled = placed;
      for (Placed& one : scaled) one.offset = fine(one.offset.hi() * unit);
      EXPECT_EQ(Far(scaled, fine(z * unit), 0, 0).near, far.near) << unit;
    }
    near += far.near.size();
    all += placed.size();
  }
  EXPECT_GT(near, all / 20);
  EXPECT_LT(near, all * 19 / 20);
}

/// Whose square is no number that a double holds well is left to those that scale.
TEST(Columns, TheLargestAndTheSmallestAreNotLookedAtSideBySide) {
  for (const double away : {1e-145, 1e-120, 1e120, 1e145}) {
    const Far far({placed_at(PrimitiveType::point, Vec3{away, 0, 0})}, fine(Vec3{0}), 0, 0);
    EXPECT_EQ(far.near.size(), away < 1e-140 || away > 1e140 ? 1U : 0U) << away;
  }
}

}  // namespace
}  // namespace palpate::solver::internal
