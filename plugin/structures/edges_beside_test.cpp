/// The scan's own edge beside strokes, against a ball with a known edge.

#include "plugin/structures/edges_beside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "io/errors.h"
#include "io/testing/made_labels.h"

namespace palpate::plugin {
namespace {

constexpr double outline_mm = 12, edge_mm = 14;

std::shared_ptr<const io::DistanceField> outline_of_a_ball() {
  const auto inside = [](const io::Vec3& at) { return glm::length(at) < outline_mm; };
  return io::distance_of(io::made_labels(inside, 24, {}), {.reach_mm = 6});
}

/// Brighter within 14 mm of the origin, but for its lower half, in which nothing is seen.
std::shared_ptr<const io::Volume> scan_of_half_a_ball() {
  constexpr int side = 48;
  auto scan = std::make_shared<io::Volume>();
  scan->geometry.dimensions = {side, side, side};
  scan->geometry.spacing_i = scan->geometry.spacing_j = 1;
  scan->geometry.step = {0, 0, 1};
  for (int k = 0; k < side; ++k) scan->geometry.slice_positions.emplace_back(-24, -24, k - 24);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 3);
  std::vector<float> values;
  for (int n = 0; n < side * side * side; ++n) {
    const io::Vec3 at(n % side - 24, n / side % side - 24, n / (side * side) - 24);
    const double ball = at.z > 0 ? 100 * (1 + std::tanh(edge_mm - glm::length(at))) : 200;
    values.push_back(static_cast<float>(noise(random) + ball));
  }
  scan->voxels = values;
  return scan;
}

TEST(EdgesBeside, LieOnTheScansEdge) {
  const auto outline = outline_of_a_ball();
  std::vector<io::Vec3> places;
  for (const io::Vec3 way : {io::Vec3(0, 0, 1), {0.6, 0, 0.8}, {-0.36, 0.48, 0.8}}) places.push_back(outline_mm * way);
  places.emplace_back(0, 0, -outline_mm);
  const auto found = edges_beside(places, *outline, scan_of_half_a_ball(), 6);
  ASSERT_EQ(found.size(), 4U);
  for (int n = 0; n < 3; ++n) {
    ASSERT_TRUE(found[n]) << n;
    EXPECT_NEAR(glm::length(found[n]->place_mm), edge_mm, 0.15);
    EXPECT_NEAR(found[n]->off_mm, outline_mm - edge_mm, 0.3) << "outwards";
    EXPECT_GT(found[n]->known_to_mm, 0);
    EXPECT_LT(found[n]->known_to_mm, 0.5);
  }
  EXPECT_FALSE(found[3]) << "there is none";
  EXPECT_THROW(edges_beside(places, *outline, scan_of_half_a_ball(), 6, [](double) { return false; }), io::Cancelled);
}

TEST(EdgesBeside, AreKnownAsWellAsTheEdgeThatIsFelt) {
  const auto outline = outline_of_a_ball();
  const auto scan = scan_of_half_a_ball();
  const std::vector<io::Vec3> places{{0, 0, edge_mm + 0.2}, {0, 0, outline_mm + 0.3}, {0, 0, -edge_mm}};
  const auto known = known_to_of(edges_beside(places, *outline, scan, 2));
  ASSERT_EQ(known.size(), 3U);
  EXPECT_GT(known[0], 0);
  EXPECT_EQ(known[1], 0) << "it lies beside the edge";
  EXPECT_EQ(known[2], 0) << "there is none";
}

TEST(EdgesBeside, TheOutlineIsMetWhereARayEntersIt) {
  const auto outline = outline_of_a_ball();
  for (const double beside : {0.0, 5.0, 11.0}) {
    const auto met = first_on_outline(*outline, {beside, 0, 300}, {beside, 0, -300});
    ASSERT_TRUE(met) << beside;
    EXPECT_NEAR(glm::length(*met), outline_mm, 0.3);
    EXPECT_GT(met->z, 0) << "in front";
    EXPECT_NEAR(outline->sample(*met).mm, 0, 0.05);
  }
  EXPECT_FALSE(first_on_outline(*outline, {13, 0, 300}, {13, 0, -300}));
  EXPECT_FALSE(first_on_outline(*outline, {0, 0, 0}, {0, 0, 0}));
}

}  // namespace
}  // namespace palpate::plugin
