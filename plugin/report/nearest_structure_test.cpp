#include "plugin/report/nearest_structure.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "plugin/report/summary.h"

namespace palpate::plugin {
namespace {

modes::Scene three_structures() {
  modes::Scene scene;
  scene.structures = {{.name = "liver"}, {.name = "aorta", .margin_mm = 3}, {.name = "cava", .margin_mm = 5}};
  return scene;
}

TickRecord tick_at(double liver, double aorta, double cava) {
  TickRecord tick;
  for (double& mm : tick.distance_mm) mm = std::numeric_limits<double>::quiet_NaN();
  tick.distance_mm[0] = liver;
  tick.distance_mm[1] = aorta;
  tick.distance_mm[2] = cava;
  return tick;
}

TEST(NearestStructure, IsTheNearestEdgeWhereNoMarginIsEntered) {
  const std::vector<std::size_t> all{0, 1, 2};
  const auto nearest = nearest_structure(tick_at(2, -4, -7), three_structures(), all);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->structure, 0U);
  EXPECT_FALSE(nearest->within_margin);
}

TEST(NearestStructure, IsTheOneFarthestWithinItsMargin) {
  const std::vector<std::size_t> all{0, 1, 2};
  auto nearest = nearest_structure(tick_at(-0.1, -2, -4.5), three_structures(), all);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->structure, 1U);  // a millimeter within; the other half of one
  EXPECT_TRUE(nearest->within_margin);
  nearest = nearest_structure(tick_at(-0.1, -2, 1), three_structures(), all);
  EXPECT_EQ(nearest->structure, 2U);  // inside it
}

TEST(NearestStructure, FollowsTheOrderOfTheTicks) {
  const std::vector<std::size_t> turned{2, 0};
  const auto nearest = nearest_structure(tick_at(-9, -1, -2), three_structures(), turned);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->structure, 0U);
  EXPECT_EQ(nearest->distance_mm, -1);
  EXPECT_FALSE(nearest_structure(tick_at(1, 1, 1), three_structures(), {}));
}

TEST(NearestStructure, IsToldInWords) {
  EXPECT_EQ(distance_in_words(-2.14, "aorta"), "2.1 mm from aorta");
  EXPECT_EQ(distance_in_words(3, "liver"), "3.0 mm inside liver");
}

/// A margin is entered where the distance is less than it, and not where it is reached; of two that are entered alike
/// deep the first is told.
TEST(NearestStructure, AMarginEndsWhereItIsReached) {
  const std::vector<std::size_t> all{0, 1, 2};
  auto nearest = nearest_structure(tick_at(-0.1, -3, -9), three_structures(), all);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->structure, 0U);
  EXPECT_FALSE(nearest->within_margin);
  nearest = nearest_structure(tick_at(-0.1, -2.999, -9), three_structures(), all);
  EXPECT_EQ(nearest->structure, 1U);
  EXPECT_EQ(nearest->distance_mm, -2.999);
  nearest = nearest_structure(tick_at(-0.1, -2, -4), three_structures(), all);
  EXPECT_EQ(nearest->structure, 1U);
  nearest = nearest_structure(tick_at(4, -4, -9), three_structures(), all);
  EXPECT_EQ(nearest->structure, 0U);
}

}  // namespace
}  // namespace palpate::plugin
