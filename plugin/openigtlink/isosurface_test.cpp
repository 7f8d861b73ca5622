// A surface against mathematics: its points are on it, it is closed, and its normals point outwards.

#include "plugin/openigtlink/isosurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <random>

namespace palpate::plugin::igtl {
namespace {

SurfaceDistance ball(const glm::dvec3& at, const glm::dvec3& center, double radius) {
  const glm::dvec3 from = at - center;
  const double r = glm::length(from);
  return {.mm = radius - r, .gradient = r > 0 ? -from / r : glm::dvec3(1, 0, 0)};
}

double volume_of(const Surface& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    sum += glm::dot(surface.points[a], glm::cross(surface.points[b], surface.points[c])) / 6;
  }
  return sum;
}

/// Every edge is in two triangles, once in each direction.
bool is_closed(const Surface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& triangle : surface.triangles) {
    for (std::size_t n = 0; n < 3; ++n) ++edges[{triangle[n], triangle[(n + 1) % 3]}];
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto back = edges.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != edges.end();
  });
}

TEST(Isosurface, OfABallIsOnItClosedAndTurnedOutwards) {
  std::mt19937 seeded(11);
  std::uniform_real_distribution<double> place(-20, 20), size(5, 25);
  for (int n = 0; n < 10; ++n) {
    const glm::dvec3 center(place(seeded), place(seeded), place(seeded));
    const double radius = size(seeded);
    const Surface surface =
        isosurface([&](const glm::dvec3& at) { return ball(at, center, radius); }, {glm::dvec3(-50), glm::dvec3(50)});
    ASSERT_GT(surface.points.size(), 100U);
    for (const glm::dvec3& point : surface.points) EXPECT_NEAR(glm::distance(point, center), radius, 1e-6);
    EXPECT_TRUE(is_closed(surface));
    const double exact = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
    EXPECT_NEAR(volume_of(surface), exact, 0.03 * exact);
  }
}

TEST(Isosurface, TwoBodiesAreTwo) {
  const auto distance = [](const glm::dvec3& at) {
    const SurfaceDistance a = ball(at, {-20, 0, 0}, 8), b = ball(at, {20, 0, 0}, 8);
    return a.mm > b.mm ? a : b;
  };
  const Surface surface = isosurface(distance, {glm::dvec3(-40), glm::dvec3(40)});
  EXPECT_TRUE(is_closed(surface));
  EXPECT_NEAR(volume_of(surface), 2 * 4.0 / 3 * std::numbers::pi * 512, 130);
}

// A large one has larger cells, and not more of them.
TEST(Isosurface, ALargeOneStaysSmall) {
  const Surface surface = isosurface([](const glm::dvec3& at) { return ball(at, glm::dvec3(0), 200); },
                                     {glm::dvec3(-250), glm::dvec3(250)});
  EXPECT_GT(surface.points.size(), 5000U);
  EXPECT_LT(surface.points.size(), 60'000U);
  EXPECT_TRUE(is_closed(surface));
}

TEST(Isosurface, OfNothingIsNothing) {
  EXPECT_TRUE(isosurface([](const glm::dvec3&) { return SurfaceDistance{.mm = -1000}; }, {glm::dvec3(0), glm::dvec3(9)})
                  .points.empty());
}

}  // namespace
}  // namespace palpate::plugin::igtl
