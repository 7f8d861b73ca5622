#include "modes/tick/anchor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "modes/scene/defaults.h"
#include "modes/testing/test_rig.h"
#include "testdata/analytic.h"

namespace palpate::modes {
namespace {

// The experiment of Creep: s = 3 N, k = 400 N/m, pushed by 1.39 N, 60 s at 1 kHz; noise of 0.02 mm rms on each axis.
constexpr double wall_strength_n = 3.0;
constexpr double push_n = 1.39;
constexpr double push_mm = push_n / 400.0 * 1000.0;
constexpr int creep_ticks = 60000;

struct Wall {
  const char* name;
  double radius_mm;
  bool concave;  ///< felt from inside the cavity
};

testdata::Phantom phantom_of(const Wall& wall) {
  return wall.concave ? testdata::make_shell(wall.radius_mm, wall.radius_mm + 20)
                      : testdata::make_sphere(wall.radius_mm);
}

struct Creep {
  double least_n = 1e9, most_n = 0;  ///< normal force, noise averaged over 100 ticks, after the first second
};

/// Presses on to the wall, then holds there with noise, or slides along it on a great circle.
Creep hold(const Wall& wall, double speed_mm_per_ms, double noise_mm) {
  const testdata::AnalyticSource source(phantom_of(wall), 1.0);
  // The strength switches on at the mid-value of the edge: the felt radius is the wall's.
  testing::Hand hand(
      testing::scene_of({testing::surface(TransferFunction({{-490, 0}, {-470, wall_strength_n}}), Datum::value)}),
      source);
  const double outward = wall.concave ? -1.0 : 1.0;
  const double pressed_radius = wall.radius_mm - outward * push_mm;
  hand.stroke({0, 0, wall.radius_mm + outward * 5}, {0, 0, pressed_radius}, 2000);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, noise_mm);
  Creep creep;
  double angle = 0, sum = 0;
  for (int tick = 1; tick <= creep_ticks; ++tick) {
    angle += speed_mm_per_ms / wall.radius_mm;
    const Vec3 radial{std::sin(angle), 0, std::cos(angle)};
    const double x = noise(random), y = noise(random), z = noise(random);  // in this order with every compiler
    hand.move_to(radial * pressed_radius + Vec3(x, y, z));
    sum += glm::dot(hand.force(), radial) * outward;
    if (tick % 100 == 0) {
      creep.least_n = std::min(creep.least_n, sum / 100);
      creep.most_n = std::max(creep.most_n, sum / 100);
      sum = 0;
    }
  }
  return creep;
}

constexpr Wall walls[] = {{"concave R = 10 mm", 10, true},
                          {"convex R = 10 mm", 10, false},
                          {"concave R = 50 mm", 50, true},
                          {"convex R = 50 mm", 50, false},
                          {"concave R = 5 mm", 5, true}};

TEST(Anchor, noise_at_rest_does_not_work_the_proxy_through_a_wall) {
  for (const Wall& wall : {walls[0], walls[1]}) {
    const Creep creep = hold(wall, 0, 0.02);
    EXPECT_GT(creep.least_n, 0.98 * push_n) << wall.name;
    EXPECT_LT(creep.most_n, 1.02 * push_n) << wall.name;
  }
}

TEST(Anchor, sliding_does_not_work_the_proxy_through_a_wall) {
  for (const Wall& wall : walls) {
    const Creep creep = hold(wall, 0.2, 0);
    EXPECT_GT(creep.least_n, 0.98 * push_n) << wall.name;
    EXPECT_LT(creep.most_n, 1.02 * push_n) << wall.name;
  }
}

/// Along the gradient, by Newton's step, however steep or flat the field is, and never farther than its bound: a
/// gradient that is so small that its length is not known moves nothing.
TEST(Anchor, StepIsNewtonsAndNoLongerThanItsBound) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> along;
  std::uniform_real_distribution<double> exponent(-170, 6), way_mm(-0.3, 0.3);
  for (int n = 0; n < 4000; ++n) {
    const double x = along(random), y = along(random), z = along(random);
    const Vec3 direction = glm::normalize(Vec3(x, y, z));
    const double slope = std::pow(10, exponent(random)), mm = way_mm(random);
    HeldSurface contact{.hold = HoldState::held, .level = 0, .held_level = mm * slope, .gradient = slope * direction};
    const Vec3 step_mm = anchor_step_mm(contact);
    const double expected = slope < 1e-149 ? glm::dot(step_mm, direction)
                                           : std::clamp(mm, -defaults::anchor_step_mm, defaults::anchor_step_mm);
    EXPECT_LE(glm::length(step_mm), defaults::anchor_step_mm * (1 + 1e-9)) << slope;
    EXPECT_LE(glm::length(step_mm - expected * direction), 1e-9) << slope;
  }
}

/// Where it is held and moves along the surface, the level returns to the value that is found there; where that is far
/// off, along the slope of a millimeter, however steep it is.
TEST(Anchor, LevelReturnsByNoMoreThanAMillimetersSlope) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-3, 4), moved_mm(0.01, 30), away(-3, 3);
  for (int n = 0; n < 2000; ++n) {
    const double slope = std::pow(10, exponent(random)), mm = moved_mm(random), far_off = away(random) * slope;
    HeldSurface contact{
        .hold = HoldState::held, .before = HoldState::held, .level = 50, .value = 50, .gradient = {0, 0, slope}};
    follow_level(50 + far_off, {0, 0, slope}, {mm, 0, 0}, contact);
    const double part = 1 - std::exp(-mm / defaults::level_length_mm);
    const double most = defaults::level_reach_mm * slope;
    EXPECT_NEAR(contact.level, 50 + part * std::clamp(far_off, -most, most), 1e-9 * (1 + slope)) << slope;
  }
}

}  // namespace
}  // namespace palpate::modes
