// The level of a surface and its anchor, step by step, against what is worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "modes/tick/anchor.h"

namespace palpate::modes {
namespace {

const Vec3 rise{0, 0, 10};  // per mm

/// Followed to the origin, where the value is 100, and then with this hold.
HeldSurface begun(HoldState before, HoldState hold) {
  HeldSurface surface;
  surface.hold = HoldState::none;
  surface.level = surface.value = 7;  // of another place: forgotten
  follow_level(100, rise, {50, 60, 70}, surface);
  EXPECT_EQ(surface.level, 100);
  surface.hold = before;
  follow_level(100, rise, {0, 0, 0}, surface);
  surface.level = 100;
  surface.hold = hold;
  return surface;
}

TEST(Holds, of_any_surfaces_in_any_order_join_to_the_one_that_is_felt) {
  using enum HoldState;
  const std::vector<HoldState> from_least_to_most{none, lifted, yielding, held};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t c = 0; c < 4; ++c) {
        const HoldState all = joined(joined(from_least_to_most[a], from_least_to_most[b]), from_least_to_most[c]);
        EXPECT_EQ(all, from_least_to_most[std::max({a, b, c})]) << a << b << c;
      }
    }
  }
}

TEST(Level, straight_across_is_the_value_unless_the_surface_holds) {
  for (const HoldState hold : {HoldState::lifted, HoldState::yielding}) {
    HeldSurface surface = begun(hold, hold);
    for (int n = 1; n <= 4; ++n) {  // a slope of 40 where the smoothed one says 10
      follow_level(100 + 40 * 0.2 * n, rise, {0, 0, 0.2 * n}, surface);
      EXPECT_NEAR(surface.level, 100 + 8 * n, 1e-12);
    }
  }
  HeldSurface held = begun(HoldState::lifted, HoldState::held);
  follow_level(108, rise, {0, 0, 0.2}, held);
  EXPECT_DOUBLE_EQ(held.level, 102) << "the smoothed slope";
  follow_level(111, 3.0 * rise, {0, 0, 0.3}, held);  // the mean of both slopes; 1 mm along, it is drawn by 1
  EXPECT_NEAR(held.level, 104 + -std::expm1(-0.1 / 20) * (111 - 6 - 104), 1e-12);
}

TEST(Level, along_a_surface_that_yields_is_not_drawn_to_the_value) {
  HeldSurface surface = begun(HoldState::yielding, HoldState::yielding);
  for (int n = 1; n <= 10; ++n) {
    follow_level(100 + 3 * n, rise, {0.5 * n, 0, 0}, surface);
    EXPECT_EQ(surface.level, 100);
  }
  surface.hold = HoldState::lifted;
  follow_level(104, rise, {6, 0, 0}, surface);
  EXPECT_NEAR(surface.level, 100 - std::expm1(-1.0 / 20) * 4, 1e-12) << "once it is lifted, it is";
}

/// Over 20 mm it comes back to the offset from the value that it had when the hold began, however the way is cut up.
TEST(Level, of_a_surface_that_holds_returns_to_the_value_with_its_first_offset) {
  for (const double step_mm : {0.1, 1.0, 5.0}) {
    HeldSurface surface = begun(HoldState::lifted, HoldState::held);
    follow_level(97, rise, {1, 0, 0}, surface);
    EXPECT_DOUBLE_EQ(surface.level, 100) << "3 above the value from here on";
    for (double way = step_mm; way < 60.01; way += step_mm) {
      follow_level(102, rise, {1 + way, 0, 0}, surface);
      ASSERT_NEAR(surface.level, 105 - 5 * std::exp(-way / 20), 1e-9) << step_mm << ' ' << way;
    }
    const double level = surface.level;
    surface.hold = HoldState::lifted;
    const double x = surface.place_mm.x + 2;
    follow_level(102, rise, {x, 0, 0}, surface);
    EXPECT_NEAR(surface.level, level - std::expm1(-2.0 / 20) * (102 - level), 1e-12) << "without the offset again";
    surface.hold = HoldState::held;
    follow_level(90, rise, {x + 1, 0, 0}, surface);
    EXPECT_DOUBLE_EQ(surface.offset, surface.level - 90) << "a new hold has its own";
  }
}

TEST(Level, is_drawn_no_faster_than_to_what_is_a_millimeter_away) {
  for (const double far : {1000.0, -1000.0}) {
    HeldSurface surface = begun(HoldState::lifted, HoldState::held);
    follow_level(100, rise, {1, 0, 0}, surface);
    follow_level(100 + far, rise, {2, 0, 0}, surface);
    EXPECT_NEAR(surface.level, 100 - std::expm1(-1.0 / 20) * std::copysign(10, far), 1e-12);
  }
}

TEST(Level, of_a_proxy_that_rests_stays_to_the_last_bit) {
  for (const HoldState hold : {HoldState::lifted, HoldState::held, HoldState::yielding}) {
    HeldSurface surface = begun(HoldState::lifted, hold);
    follow_level(97, {1, 2, 10}, {1.1, 0.3, -0.2}, surface);
    const double level = surface.level;
    for (int n = 0; n < 3; ++n) follow_level(97, {1, 2, 10}, {1.1, 0.3, -0.2}, surface);
    EXPECT_EQ(surface.level, level);
  }
}

TEST(AnchorStep, is_one_newton_step_back_to_the_level_that_holds_and_at_most_a_tenth_of_a_millimeter) {
  HeldSurface surface{.hold = HoldState::held, .level = 103, .held_level = 102.5, .gradient = {0, 6, 8}};
  const Vec3 step = anchor_step_mm(surface);
  EXPECT_LT(glm::length(step - Vec3(0, -0.03, -0.04)), 1e-15);
  EXPECT_NEAR(level_at_anchor(surface, step), 102.5, 1e-12);
  for (const double far : {50.0, -50.0}) {
    surface.held_level = surface.level + far;
    EXPECT_LT(glm::length(anchor_step_mm(surface) - std::copysign(0.1, far) * Vec3(0, 0.6, 0.8)), 1e-15);
    EXPECT_EQ(surface.held_level, surface.level + far) << "it is not renewed while it holds";
  }
  surface.gradient = Vec3(0);
  EXPECT_EQ(anchor_step_mm(surface), Vec3(0)) << "no direction";
  surface.gradient = {0, 6, 8};
  for (const HoldState hold : {HoldState::none, HoldState::lifted, HoldState::yielding}) {
    surface.hold = hold;
    surface.held_level = 0;
    EXPECT_EQ(anchor_step_mm(surface), Vec3(0));
    EXPECT_EQ(surface.held_level, surface.level);
  }
}

TEST(HeldSurfaces, are_held_where_any_is_and_forgotten_all_at_once) {
  HeldSurfaces surfaces;
  EXPECT_FALSE(surfaces.is_held());
  std::vector<HeldSurface*> all{&surfaces.scan};
  for (HeldSurface& surface : surfaces.structure) all.push_back(&surface);
  for (HeldSurface* one : all) {
    for (HeldSurface* other : all) other->hold = HoldState::yielding;
    EXPECT_FALSE(surfaces.is_held());
    one->hold = HoldState::held;
    EXPECT_TRUE(surfaces.is_held());
    surfaces.release();
    for (HeldSurface* other : all) EXPECT_EQ(other->hold, HoldState::none);
  }
}

}  // namespace
}  // namespace palpate::modes
