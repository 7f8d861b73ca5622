/// The law of certify.h at a point, against the same law written plainly: what each primitive contributes, with its
/// given force or its full one, whichever is cheaper.

#include "solver/exact/bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <vector>

#include "solver/testing/problems.h"

namespace palpate::solver::internal {
namespace {

struct Plain {
  Vec3 force{0};
  double slack = 0;
};

/// An admissible force near to the one given, and phi(x) - F . (x_i - x) of it.
Plain given_of(const Primitive& primitive, const Vec3& miss, const Vec3& force) {
  const double s = primitive.strength;
  const Vec3& q = primitive.direction;
  switch (primitive.type) {
    case PrimitiveType::directed_force:
      return {q * s, 0};
    case PrimitiveType::plane: {
      const double depth = glm::dot(miss, q);
      const double given = std::clamp(glm::dot(force, q), 0.0, s);
      return {q * given, depth > 0 ? (s - given) * depth : -given * depth};
    }
    default: {
      const bool is_line = primitive.type == PrimitiveType::line;
      const Vec3 across = is_line ? miss - q * glm::dot(q, miss) : miss;
      Vec3 given = is_line ? force - q * glm::dot(q, force) : force;
      if (glm::length(given) > s) given *= s / glm::length(given);
      return {given, s * glm::length(across) - glm::dot(given, across)};
    }
  }
}

Plain cheaper_of(const Primitive& primitive, const Vec3& x, const Vec3& force, double stiffness) {
  const Plain given = given_of(primitive, primitive.position - x, force);
  const Vec3 full = force_on(primitive, x);
  const Vec3 change = full - given.force;
  return glm::dot(change, change) <= stiffness * given.slack ? Plain{full, 0} : given;
}

double law(double residual, double slack, double stiffness) {
  return (residual + std::sqrt(residual * residual + 4 * stiffness * slack)) / (2 * stiffness);
}

TEST(Bound, IsTheLawOfWhatEachPrimitiveContributes) {
  int with_slack = 0;
  for (const Family family : {Family::oblique, Family::co_located, Family::spread}) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      const Problem problem = make_problem(family, seed);
      Random random(seed);
      const double size = random.log_uniform(1e-5, 1e-2);
      const Vec3 x = problem.previous_proxy + random.normal_vector(size);
      std::vector<Vec3> forces;
      Vec3 sum(0);
      double slack = 0;
      for (const Primitive& primitive : problem.primitives) {
        forces.push_back(random.normal_vector(0.5 * std::max(0.1, primitive.strength)));
        const Plain plain = cheaper_of(primitive, x, forces.back(), problem.stiffness);
        sum += plain.force;
        slack += plain.slack;
      }
      with_slack += slack > 0 ? 1 : 0;
      const double residual = glm::length(problem.stiffness * (x - problem.probe) - sum);
      const Bound bound = bound_at(PlacedPrimitives(problem.primitives, problem.probe), problem.stiffness,
                                   exact_difference(x, problem.probe), {}, forces);
      SCOPED_TRACE(::testing::Message() << name_of(family) << " " << seed);
      ASSERT_NEAR(bound.residual, residual, 1e-9 * (1 + residual));
      ASSERT_NEAR(bound.slack, slack, 1e-12 + 1e-9 * slack);
      const double expected = law(residual, slack, problem.stiffness);
      ASSERT_NEAR(bound.error, expected, 1e-9 * expected + 1e-13);
      // Away from every primitive, what its data's rounding may forgive is nothing to speak of.
      ASSERT_LE(bound.backward_error, bound.error);
      ASSERT_NEAR(bound.backward_error, expected, 1e-6 * expected + 1e-12);
    }
  }
  EXPECT_GT(with_slack, 1000);
}

/// What a primitive may be moved by the rounding of its data is forgiven in one of the bounds and not in the other.
TEST(Bound, ForgivesTheRoundingOfTheDataInTheBackwardErrorAlone) {
  constexpr double stiffness = 400, strength = 1;
  const Vec3 probe(0.1, 0.2, 0.3);
  for (const double ulps : {0.5, 1.0, 100.0}) {
    // A plane's half force holds the proxy 0.2 ulp of the coordinates off the plane.
    const double off = ulps * std::numeric_limits<double>::epsilon() * 0.01;
    const Vec3 normal(0, 1, 0);
    const std::vector<Primitive> primitives{make_plane(strength, probe + Vec3(0, 0.01, 0), normal)};
    const std::vector<Vec3> forces{0.5 * normal};
    const FineVec3 z = exact_difference(primitives[0].position, probe) - fine(normal * off);
    const Bound bound = bound_at(PlacedPrimitives(primitives, probe), stiffness, z, {}, forces);
    const double residual = std::abs(stiffness * z.y.hi - 0.5);
    EXPECT_GE(bound.error, law(residual, 0.5 * off, stiffness));
    if (ulps <= 1) {
      EXPECT_NEAR(bound.backward_error, residual / stiffness, 1e-15);
    } else {
      EXPECT_GT(bound.backward_error, law(residual, 0.4 * off, stiffness));
    }
  }
}

/// A hard constraint is met or not; the rounding of its data alone does not count as missing it.
TEST(Bound, OfAHardPlaneForgivesTheRoundingOfItsDataAlone) {
  constexpr double stiffness = 400;
  const Vec3 probe(0.1, 0.2, 0.3), normal(0, 1, 0);
  const std::vector<Primitive> primitives{
      make_plane(std::numeric_limits<double>::infinity(), probe + 0.01 * normal, normal)};
  const std::vector<Vec3> forces{0.5 * normal};
  for (const double ulps : {0.5, 1.0, 100.0}) {
    const double off = ulps * std::numeric_limits<double>::epsilon() * 0.01;
    const FineVec3 z = exact_difference(primitives[0].position, probe) - fine(normal * off);
    const Bound bound = bound_at(PlacedPrimitives(primitives, probe), stiffness, z, {}, forces);
    EXPECT_TRUE(std::isinf(bound.error)) << ulps;
    if (ulps <= 1) {
      EXPECT_NEAR(bound.backward_error, std::abs(stiffness * z.y.hi - 0.5) / stiffness, 1e-15);
    } else {
      EXPECT_TRUE(std::isinf(bound.backward_error));
    }
  }
}

/// A seeded balance, placed, with forces that are about as strong as its primitives, and a point near it.
struct Situation {
  explicit Situation(std::uint64_t seed)
      : problem(make_problem(all_families[seed % std::size(all_families)], seed)), random(seed) {
    for (const Primitive& primitive : problem.primitives) {
      place(primitive, problem.probe, placed.emplace_back());
      const double strength = std::isinf(primitive.strength) ? 1 : primitive.strength;
      forces.push_back(random.uniform(0, 1.5) * strength * random.unit_vector());
    }
    z = exact_difference(problem.previous_proxy, problem.probe);
  }
  Problem problem;
  Random random;
  std::vector<Placed> placed;
  std::vector<Vec3> forces;
  FineVec3 z{};
};

void expect_same(const Bound& a, const Bound& b, std::uint64_t seed) {
  EXPECT_EQ(a.error, b.error) << seed;
  EXPECT_EQ(a.backward_error, b.backward_error) << seed;
  EXPECT_EQ(a.residual, b.residual) << seed;
  EXPECT_EQ(a.slack, b.slack) << seed;
}

TEST(BoundAt, IsOnItsFlatAsIfThatsPrimitivesStoodThere) {
  for (std::uint64_t seed = 0; seed < 2200; ++seed) {
    Situation here(seed);
    Flat flat;
    std::vector<Placed> there = here.placed;
    const std::size_t count = std::min<std::size_t>(1 + seed % 3, there.size());
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t chosen = here.random.below(there.size());
      if (there[chosen].type == PrimitiveType::directed_force || flat.has(chosen)) continue;
      flat.chosen[flat.count++] = static_cast<std::uint32_t>(chosen);
      there[chosen].offset = here.z;
    }
    const double stiffness = here.problem.stiffness;
    expect_same(bound_at(PlacedPrimitives(here.placed), stiffness, here.z, flat, here.forces),
                bound_at(PlacedPrimitives(there), stiffness, here.z, {}, here.forces), seed);
  }
}

/// s |m| - F . m at a point, or 0 where the force is the full one there but for what its error covers.
double true_slack(const Placed& primitive, const Contribution& share, const FineVec3& z) {
  const Vec3 to_it = (primitive.offset - z).hi();
  const double s = primitive.strength;
  if (primitive.type == PrimitiveType::plane) {
    const double depth = glm::dot(to_it, primitive.direction);
    const double given = glm::dot(share.force, primitive.direction);
    return depth > 0 ? (s - given) * depth : -given * depth;
  }
  const bool is_line = primitive.type == PrimitiveType::line;
  const Vec3 miss = is_line ? to_it - primitive.direction * glm::dot(primitive.direction, to_it) : to_it;
  const double length = glm::length(miss), size = glm::length(share.force);
  if (glm::length(miss * (s / length) - share.force) <= share.force_error) return 0;
  const Vec3 force = std::abs(s - size) <= share.force_error ? share.force * (s / size) : share.force;
  return s * length - glm::dot(force, miss);
}

/// Where a point is known to a distance alone, the slack holds at every point within it. Forces of full size almost the
/// primitive's way count most: those are of friction that is about to slip.
TEST(ShareOf, HoldsAtEveryPointThatMayBeMeant) {
  int full = 0, turned = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const double s = random.log_uniform(0.1, 10), far = random.log_uniform(1e-6, 1e-2);
    const Vec3 way = random.unit_vector(), place_of_it = random.normal_vector(1e-2);
    const Primitive primitive = seed % 3 == 0   ? make_point(s, place_of_it)
                                : seed % 3 == 1 ? make_line(s, place_of_it, random.unit_vector())
                                                : make_plane(s, place_of_it, random.unit_vector());
    Placed placed;
    place(primitive, Vec3{0}, placed);
    const FineVec3 z = fine(place_of_it - far * way);
    const double doubt = far * random.uniform(0, 0.24);
    const Vec3 aim = force_on(primitive, z.hi());
    const double off = random.log_uniform(1e-6, 1);
    Vec3 force = glm::length(aim) > 0 ? s * glm::normalize(aim / s + off * random.unit_vector()) : s * way;
    if (primitive.type == PrimitiveType::line) force -= placed.direction * glm::dot(placed.direction, force);
    if (seed % 5 != 0) force *= s / glm::length(force);
    const Contribution share = share_of(placed, z, force, random.log_uniform(1, 1e5), doubt);
    full += share.slack == 0 ? 1 : 0;
    turned += share.slack > 0 ? 1 : 0;
    for (int n = 0; n < 8; ++n) {
      const FineVec3 meant = z + fine(doubt * random.unit_vector());
      ASSERT_LE(true_slack(placed, share, meant), share.slack * (1 + 1e-12) + 1e-14 * s * far) << seed;
    }
  }
  EXPECT_GT(full, 1000);
  EXPECT_GT(turned, 1000);
}

TEST(BoundOf, IsTheLawWhereNoFlatHolds) {
  for (std::uint64_t seed = 0; seed < 2200; ++seed) {
    const Situation here(seed);
    const double stiffness = here.problem.stiffness;
    std::vector<Contribution> shares;
    for (std::size_t i = 0; i < here.placed.size(); ++i) {
      shares.push_back(share_of(here.placed[i], here.z, here.forces[i], stiffness));
    }
    expect_same(bound_of(shares, stiffness, here.z),
                bound_at(PlacedPrimitives(here.placed), stiffness, here.z, {}, here.forces), seed);
  }
}

}  // namespace
}  // namespace palpate::solver::internal
