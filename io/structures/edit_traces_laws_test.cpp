// Laws of traces of many points, and of points that lie close together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "io/structures/edits.h"
#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

std::shared_ptr<const DistanceField> traced_ball(double radius_mm) {
  DistanceOptions near;
  near.reach_mm = 5;
  return distance_of(made_labels([=](const Vec3& at) { return glm::length(at) < radius_mm; }, radius_mm + 8), near);
}

/// Directions at equal distances, from the top down to this height of a unit ball.
std::vector<Vec3> directions(int count, double down_to) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> all;
  for (int n = 0; n < count; ++n) {
    const double z = 1 - (1 - down_to) * (n + 0.5) / count, r = std::sqrt(1 - z * z);
    all.emplace_back(r * std::cos(golden * n), r * std::sin(golden * n), z);
  }
  return all;
}

/// A point within a quarter of the reach of one before is left out, with what it says of its uncertainty.
TEST(TraceLaws, APointBesideAKnownOneChangesNothing) {
  constexpr double radius_mm = 18, reach_mm = 8;
  const auto ball = traced_ball(radius_mm);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int more = 1; more <= 3; ++more) {
    TraceEdit alone{.points_mm = {}, .known_to_mm = {}, .reach_mm = reach_mm}, among = alone;
    const auto add = [](TraceEdit& trace, const Vec3& place, double known_to_mm) {
      trace.points_mm.push_back(place);
      trace.known_to_mm.push_back(known_to_mm);
    };
    for (const Vec3& way : directions(14, -0.2)) {
      const Vec3 place = (radius_mm + 1.5 + any(random)) * way;
      const double known_to_mm = 3 + 3 * any(random);
      add(alone, place, known_to_mm);
      add(among, place, known_to_mm);
      for (int n = 0; n < more; ++n) {
        const Vec3 aside(any(random), any(random), any(random));
        add(among, place + 0.13 * reach_mm * aside, 3 + 3 * any(random));  // a cube's corner lies 1.73 of it away
      }
    }
    EditOutcome of_alone, of_among;
    const auto one = apply_edit(ball, alone, {}, &of_alone), other = apply_edit(ball, among, {}, &of_among);
    ASSERT_EQ(of_alone.points, alone.points_mm.size());
    EXPECT_EQ(of_among.points, of_alone.points);
    double most = 0;
    for (const Vec3& way : directions(300, -1)) {
      const Vec3 at = (radius_mm + any(random)) * way;
      most = std::max(most, std::abs(one->sample(at).mm - other->sample(at).mm));
    }
    EXPECT_LT(most, 1e-6) << more;
  }
}

/// A trace is fitted in pieces of 400 points. What an early one has put on the edge a later one leaves there: its
/// points lie among them, and pull outwards and inwards.
TEST(TraceLaws, AllOfManyPointsEndOnTheEdge) {
  constexpr double radius_mm = 24, pull_mm = 0.7;
  const auto ball = traced_ball(radius_mm);
  TraceEdit trace{.points_mm = {}, .known_to_mm = {}, .reach_mm = 8};
  const std::vector<Vec3> ways = directions(480, -0.37);
  for (const bool pulls : {false, true}) {
    for (std::size_t n = 0; n < ways.size(); ++n) {
      if ((n % 6 == 0) != pulls) continue;
      const double mm = !pulls ? 0 : n % 12 == 0 ? pull_mm : -pull_mm;
      trace.points_mm.push_back((radius_mm + mm) * ways[n]);
    }
  }
  EditOutcome outcome;
  const auto edited = apply_edit(ball, trace, {}, &outcome);
  ASSERT_EQ(outcome.points, trace.points_mm.size()) << "none is close to another one";
  double most = 0;
  for (const Vec3& at : trace.points_mm) most = std::max(most, std::abs(edited->sample(at).mm));
  EXPECT_LT(most, 0.1);
}

}  // namespace
}  // namespace palpate::io
