// Force laws: what is felt where, against the quasi-static balance of analytic profiles (modes.md, "What is felt
// where").
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "modes/scene/strength.h"
#include "modes/testing/test_rig.h"
#include "testdata/analytic.h"

namespace palpate::modes {
namespace {

using testdata::AnalyticSource;
using testdata::Layer;
using testing::Hand;
using testing::scene_of;
using testing::stiffness_n_per_mm;
using testing::surface;

// Oblique to patient's and device's axes: no component is zero by luck.
const Vec3 inward = glm::normalize(Vec3(0.3, 0.8, -0.52));

AnalyticSource skin_slab() {
  return AnalyticSource(testdata::make_slab(inward, std::vector<Layer>{{0.0, testdata::soft_tissue_hu}}), 1.0);
}

/// The quasi-static balance of a proxy pressed inwards: the first place, from where it was, at which the strength holds
/// the pull. depths in mm along `inward`; strength in N.
double balance_mm(const io::FieldSource& source, const Strength& strength, double probe_mm, double from_mm) {
  const auto pull_left = [&](double p) {
    return p * stiffness_n_per_mm + strength(source.sample(p * inward, source.available())) -
           probe_mm * stiffness_n_per_mm;
  };
  if (pull_left(from_mm) >= 0) {
    return from_mm;
  }
  const double step = 0.001;
  double p = from_mm;
  while (pull_left(p + step) < 0) {
    p += step;
  }
  double low = p, high = p + step;
  for (int i = 0; i < 60; ++i) {
    (pull_left(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
  }
  return high;
}

TEST(ForceLaw, pressing_on_a_rising_strength_follows_the_quasi_static_balance_within_one_tick_of_travel) {
  const AnalyticSource source = skin_slab();
  // Rises from nothing to 2.5 N towards the steepest place of the edge, at depth 0.
  const TransferFunction tau({{20, 0}, {400, 2.5}});
  const Strength strength(Datum::gradient_magnitude, tau, {});
  for (const double speed : {0.001, 0.01, 0.05, 0.2}) {  // mm per tick of 1 ms
    Hand hand(scene_of({surface(tau)}), source);
    double expected = -8;
    for (int tick = 0; tick * speed < 14; ++tick) {
      const double probe = -8 + tick * speed;
      hand.move_to(probe * inward);
      expected = std::max(expected, balance_mm(source, strength, probe, expected));
      if (expected > -0.1) {
        break;  // beyond the peak it pops through: the balance jumps, the hand follows in its own time
      }
      const double proxy = glm::dot(hand.proxy_mm(), inward);
      EXPECT_NEAR(proxy, expected, speed + 1e-9) << "probe at " << probe << ", speed " << speed;
      EXPECT_NEAR(glm::length(hand.force()), stiffness_n_per_mm * (probe - proxy), 1e-9);
    }
    EXPECT_GT(glm::length(hand.force()), 2.0) << speed;
  }
}

TEST(ForceLaw, a_boundary_is_felt_at_its_mid_value_where_the_strength_switches_on_there) {
  const AnalyticSource source = skin_slab();
  const Mode skin = surface(TransferFunction({{-481, 0}, {-479, 2.0}}), Datum::value);
  Hand hand(scene_of({skin}), source);
  hand.stroke(-5.0 * inward, 3.0 * inward, 4000);
  // -480 HU is half-way from -1000 to 40; the edge's slope there is 415 HU/mm.
  EXPECT_NEAR(glm::dot(hand.proxy_mm(), inward), 0.0, 1.0 / 415 + 8.0 / 4000);
  EXPECT_NEAR(glm::dot(hand.force(), -inward), 3 * stiffness_n_per_mm, (1.0 / 415 + 8.0 / 4000) * stiffness_n_per_mm);
}

TEST(ForceLaw, increments_are_exact_while_held_on_a_flat_slab) {
  const AnalyticSource source = skin_slab();
  for (const int most_sub_steps : {1, 8}) {
    Hand hand(scene_of({surface(TransferFunction({{-490, 0}, {-470, 2.5}}), Datum::value)}, most_sub_steps), source);
    // Deeper first: coming back to 3 mm, the place where it is held could hold more than will be asked of it.
    hand.stroke(-5.0 * inward, 4.5 * inward, 2000);
    hand.stroke(4.5 * inward, 3.0 * inward, 300);
    ASSERT_EQ(hand.result.hold, HoldState::held);
    const Vec3 force = hand.force();
    const Vec3 probe = 3.0 * inward;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1, 1);
    Vec3 offset(0);
    for (int i = 0; i < 2000; ++i) {
      const double x = any(random), y = any(random), z = any(random);  // in this order with every compiler
      offset += 0.05 * Vec3(x, y, z);
      // Held: between lift-off and yielding.
      const double depth = std::clamp(glm::dot(offset, inward), -2.5, 1.0);
      offset += (depth - glm::dot(offset, inward)) * inward;
      hand.move_to(probe + offset);
      const Vec3 expected = force - inward * (glm::dot(offset, inward) * stiffness_n_per_mm);
      EXPECT_LE(glm::length(hand.force() - expected), 1e-9) << i;
    }
  }
}

TEST(ForceLaw, nothing_is_felt_in_homogeneous_tissue_after_pushing_through) {
  const AnalyticSource source = skin_slab();
  Mode skin = surface(TransferFunction({{20, 0}, {60, 1.0}}));
  Hand hand(scene_of({skin}), source);
  hand.stroke(-30.0 * inward, -8.0 * inward, 100);
  EXPECT_EQ(hand.result.primitives.size(), 0U);
  EXPECT_EQ(hand.force(), Vec3(0));
  hand.stroke(-8.0 * inward, 30.0 * inward, 2000);
  EXPECT_EQ(hand.result.primitives.size(), 0U);
  EXPECT_EQ(hand.force(), Vec3(0));
}

TEST(ForceLaw, the_side_says_which_crossing_is_resisted) {
  const AnalyticSource source = skin_slab();
  const auto peak_force = [&source](Side side, double from, double to) {
    Hand hand(scene_of({surface(TransferFunction({{20, 0}, {60, 1.0}}), Datum::gradient_magnitude, side)}), source);
    double most = 0;
    for (int i = 0; i <= 4000; ++i) {
      hand.move_to((from + (to - from) * i / 4000.0) * inward);
      const double against = -glm::dot(hand.force(), inward) * (to > from ? 1 : -1);
      EXPECT_GE(against, -1e-12);  // a surface never pulls along
      EXPECT_LE(glm::length(hand.force()), 1.0 + 1e-12);
      most = std::max(most, against);
    }
    return most;
  };
  const auto lag = 8e-3;  // at most k v of one tick below the strength
  EXPECT_NEAR(peak_force(Side::entering, -8, 8), 1.0, lag);
  EXPECT_EQ(peak_force(Side::entering, 8, -8), 0.0);
  EXPECT_EQ(peak_force(Side::leaving, -8, 8), 0.0);
  EXPECT_NEAR(peak_force(Side::leaving, 8, -8), 1.0, lag);
  EXPECT_NEAR(peak_force(Side::both, -8, 8), 1.0, lag);
  EXPECT_NEAR(peak_force(Side::both, 8, -8), 1.0, lag);
}

TEST(ForceLaw, friction_resists_by_its_strength_in_every_direction_and_lets_go_of_nothing_less) {
  const AnalyticSource source = skin_slab();
  Mode friction;
  friction.type = "friction";
  friction.strength_n = TransferFunction({{-500, 0}, {0, 0.1}});
  Hand hand(scene_of({friction}), source);
  const Vec3 deep = 20.0 * inward;
  hand.move_to(deep);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 start = hand.proxy_mm();
    const double x = normal(random), y = normal(random), z = normal(random);
    const Vec3 along = glm::normalize(Vec3(x, y, z));
    hand.move_to(start + 0.2499 * along);  // 0.09996 N: sticks
    EXPECT_LE(glm::length(hand.proxy_mm() - start), 1e-12);
    hand.stroke(start + 0.2499 * along, start + 2.0 * along, 100);
    EXPECT_NEAR(glm::length(hand.force()), 0.1, 1e-9);
    EXPECT_LE(glm::length(hand.force() + 0.1 * along), 1e-9);
    hand.move_to(hand.proxy_mm());
  }
}

}  // namespace
}  // namespace palpate::modes
