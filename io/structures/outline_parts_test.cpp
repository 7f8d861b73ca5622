// Parts and holes of analytic bodies: their number and size.
#include "io/structures/outline_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

double ball_volume(double radius) {
  return 4.0 / 3 * glm::pi<double>() * radius * radius * radius;
}

InsideOf in_ball(const Vec3& center, double radius) {
  return [=](const Vec3& at) { return glm::distance(at, center) < radius; };
}

TEST(OutlineParts, EveryPartAndHoleIsCountedOnceAtItsPlaceAndSize) {
  const InsideOf large = in_ball({0, 0, 0}, 18), hole = in_ball({4, 3, -2}, 5), island = in_ball({-24, 20, 4}, 4);
  const auto body = [=](const Vec3& at) { return (large(at) && !hole(at)) || island(at); };
  for (const LabelLattice& lattice : {LabelLattice{}, LabelLattice{.spacing = {0.9, 1.2, 1.5}}}) {
    const auto field = distance_of(made_labels(body, 32, lattice));
    const std::vector<OutlinePlace> places = outline_places(*field, 2);
    std::vector<std::size_t> of_place;
    const std::vector<OutlinePart> parts = outline_parts(*field, places, &of_place);
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_FALSE(parts[0].is_hole);
    EXPECT_NEAR(parts[0].volume_mm3, ball_volume(18) - ball_volume(5), 0.03 * ball_volume(18));
    EXPECT_TRUE(parts[1].is_hole);
    EXPECT_NEAR(parts[1].volume_mm3, ball_volume(5), 0.1 * ball_volume(5));
    EXPECT_NEAR(parts[1].depth_mm, 5, 0.8);
    EXPECT_LT(glm::distance(parts[1].deepest_mm, Vec3(4, 3, -2)), 1.5);
    EXPECT_FALSE(parts[2].is_hole);
    EXPECT_NEAR(parts[2].volume_mm3, ball_volume(4), 0.1 * ball_volume(4));
    EXPECT_LT(glm::distance(parts[2].deepest_mm, Vec3(-24, 20, 4)), 1.5);
    ASSERT_EQ(of_place.size(), places.size());
    for (std::size_t n = 0; n < places.size(); ++n) {
      const Vec3& at = places[n].place_mm;
      const std::size_t nearest = glm::distance(at, Vec3(-24, 20, 4)) < 8   ? 2U
                                  : glm::distance(at, Vec3(4, 3, -2)) < 6.5 ? 1U
                                                                            : 0U;
      ASSERT_EQ(of_place[n], nearest);
    }
  }
}

TEST(OutlineParts, WhatIsOpenToTheOutsideIsNoHole) {
  const auto cup = [](const Vec3& at) {
    return glm::length(at) < 16 && !(glm::length(at) < 11) && !(glm::length(glm::dvec2(at.x, at.y)) < 3 && at.z > 0);
  };
  EXPECT_EQ(outline_parts(*distance_of(made_labels(cup, 24))).size(), 1U);
  // A body of which no brick is kept in the middle, and one that nothing but bricks holds.
  EXPECT_EQ(outline_parts(*distance_of(made_labels(in_ball({0, 0, 0}, 40), 46))).size(), 1U);
  EXPECT_EQ(outline_parts(*distance_of(made_labels(in_ball({0, 0, 0}, 3), 8))).size(), 1U);
}

}  // namespace
}  // namespace palpate::io
