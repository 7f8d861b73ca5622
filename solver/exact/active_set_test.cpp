#include "solver/exact/active_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "solver/testing/problems.h"

namespace palpate::solver::internal {
namespace {

/// Up to three primitives that are locked in turn; `placed` holds more, of all kinds.
struct Locked {
  explicit Locked(std::uint64_t seed) {
    const Problem problem = make_problem(Family::many, seed, 12);
    for (const Primitive& primitive : problem.primitives) {
      if (primitive.type != PrimitiveType::directed_force) place(primitive, problem.probe, placed.emplace_back());
    }
    for (std::uint32_t i = 0; i < placed.size() && active.count < static_cast<int>(1 + seed % 3); ++i) {
      internal::lock(active, placed, i);
    }
  }
  std::vector<Placed> placed;
  ActiveSet active;
};

/// The part of v that a primitive can push along: all of it for a point.
Vec3 pushed(const Placed& primitive, const Vec3& v) {
  if (primitive.type == PrimitiveType::point) return v;
  const Vec3 along = primitive.direction * glm::dot(primitive.direction, v);
  return primitive.type == PrimitiveType::plane ? along : v - along;
}

TEST(ActiveSet, EachLockedForceHasADirectionOfItsOwnAndTogetherTheyBearWhatIsAcross) {
  int with_line_and_plane = 0, ranks[4] = {};
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Locked locked(seed);
    const ActiveSet& active = locked.active;
    const Vec3 needed = Random(seed).normal_vector(1);
    Vec3 forces[3];
    share(active, locked.placed, needed, forces);
    Vec3 together{0};
    bool line = false, plane = false;
    double size = 1;
    for (int j = 0; j < active.count; ++j) {
      const Placed& primitive = locked.placed[active.locked[j]];
      size += glm::length(forces[j]);
      EXPECT_LT(glm::length(forces[j] - pushed(primitive, forces[j])), 1e-14 * size) << seed;
      together += forces[j];
      line = line || primitive.type == PrimitiveType::line;
      plane = plane || primitive.type == PrimitiveType::plane;
    }
    const Vec3 across = needed - within(active, fine(needed)).hi();
    EXPECT_LT(glm::length(together - across), 1e-13 * size) << seed;
    with_line_and_plane += line && plane ? 1 : 0;
    ++ranks[active.rank];
  }
  EXPECT_GT(with_line_and_plane, 20);
  EXPECT_GT(ranks[1], 20);
  EXPECT_GT(ranks[2], 20);
  EXPECT_GT(ranks[3], 20);
}

TEST(ActiveSet, TheFlatMeetsAllThatIsLockedAndHasTheDirectionsThatAreLeft) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Locked locked(seed);
    const ActiveSet& active = locked.active;
    FineVec3 z = fine(Random(seed).normal_vector(2e-3));
    settle(active, locked.placed, z);
    const double doubt = doubt_of(active, locked.placed, z);
    EXPECT_LT(doubt, 1e-17) << seed;
    // Of a place beside the flat it is at least the distance.
    const Vec3 off = Random(seed + 2).normal_vector(1e-3);
    const double beside = glm::length(off - within(active, fine(off)).hi());
    EXPECT_GE(doubt_of(active, locked.placed, z + fine(off)), beside * (1 - 1e-9)) << seed;
    const Vec3 free = within(active, fine(Random(seed + 1).normal_vector(1))).hi();
    for (int j = 0; j < active.count; ++j) {
      const Placed& primitive = locked.placed[active.locked[j]];
      const Vec3 to_it = (primitive.offset - z).hi();
      EXPECT_LE(glm::length(pushed(primitive, to_it)), doubt + 1e-15 * glm::length(to_it)) << seed;
      EXPECT_LT(glm::length(pushed(primitive, free)), 1e-15 / std::abs(active.size[active.count - 1])) << seed;
      // Without it the others stay locked, and more is free.
      const ActiveSet others = without(active, locked.placed, j);
      EXPECT_LT(others.rank, active.rank) << seed;
      EXPECT_FALSE(others.has(active.locked[j])) << seed;
      for (int k = 0; k < active.count; ++k) EXPECT_TRUE(k == j || others.has(active.locked[k])) << seed;
    }
  }
}

}  // namespace
}  // namespace palpate::solver::internal
