#include "solver/exact/columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
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
    const Local local = look(walk, z, walk.active);
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

}  // namespace
}  // namespace palpate::solver::internal
