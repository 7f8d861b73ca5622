#include "modes/tick/haptic_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>

#include "modes/testing/test_rig.h"
#include "solver/exact/local.h"

namespace palpate::modes {
namespace {

using testing::Hand;
using testing::scene_of;
using testing::surface;

/// A ball of value 1 with a soft edge 1 mm wide, and a vector field that swirls about the y axis; nothing beyond 40 mm.
class Ball : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override {
    return io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::vector;
  }
  io::Sample sample(const io::Vec3& p, io::FieldSet wanted) const noexcept override {
    ++samples;
    asked = wanted;
    io::Sample sample;
    const double r = glm::length(p);
    if (r > 40) {
      return sample;
    }
    sample.inside = true;
    const double edge = std::tanh((20 - r) / 0.5);
    if (contains(wanted, io::FieldSet::value)) {
      sample.value = 0.5 + 0.5 * edge;
    }
    if (contains(wanted, io::FieldSet::gradient) && r > 0) {
      sample.gradient = -(1 - edge * edge) * p / r;
    }
    if (contains(wanted, io::FieldSet::vector)) {
      sample.vector = broken ? io::Vec3(std::numeric_limits<double>::infinity(), 0, 0) : io::Vec3(-p.z, 0.3 * p.x, p.x);
    }
    return sample;
  }
  mutable int samples = 0;
  mutable io::FieldSet asked = io::FieldSet::none;
  bool broken = false;
};

Mode friction(double strength_n) {
  Mode mode;
  mode.type = "friction";
  mode.strength_n = TransferFunction(strength_n);
  return mode;
}

Mode flow_mode(const char* type, double strength_n) {
  Mode mode;
  mode.type = type;
  mode.strength_of = Datum::vector_magnitude;
  mode.strength_n = TransferFunction(strength_n);
  return mode;
}

Scene skin() {
  return scene_of({surface(TransferFunction({{0.4, 0}, {0.5, 2}}), Datum::value), friction(0.1)});
}

// A tick's balance is solved as it was before many primitives were sorted: recordings keep their bits.
static_assert(most_primitives <= solver::internal::most_unsorted);

TEST(HapticStep, starts_free_wherever_it_starts) {
  const Ball ball;
  for (const double depth : {-5.0, 0.0, 0.5, 15.0}) {
    Hand hand(skin(), ball);
    hand.move_to({0, 0, 20 - depth});
    EXPECT_EQ(hand.force(), Vec3(0));
    EXPECT_EQ(hand.result.outcome, solver::Outcome::solved);
  }
}

TEST(HapticStep, samples_once_a_sub_step_and_only_what_the_plan_reads) {
  const Ball ball;
  Hand hand(skin(), ball);
  hand.move_to({0, 0, 21});
  EXPECT_EQ(ball.samples, 1);
  EXPECT_TRUE(ball.asked == (io::FieldSet::value | io::FieldSet::gradient));
  Scene scene = skin();
  scene.subdivision = {.step_mm = 0.1, .most = 8};
  Hand fine(scene, ball);
  fine.move_to({0, 0, 21});
  for (const auto& [travel, expected] : {std::pair{0.0, 1}, {0.09, 1}, {0.25, 3}, {0.79, 8}, {5.0, 8}}) {
    ball.samples = 0;
    const Vec3 from = fine.plan.workspace.to_patient(fine.touch.probe_m);
    EXPECT_EQ(fine.move_to(from - Vec3(0, 0, travel)).sub_steps, expected) << travel;
    EXPECT_EQ(ball.samples, expected + fine.result.halts);
  }
}

/// Two membranes across z, 1.5 mm apart, each a 1 mm rise and fall of the value: the second lies within the jump that
/// the first one's strength stores in the spring.
class Membranes : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::gradient; }
  io::Sample sample(const io::Vec3& p, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = true;
    for (const auto& [z, height] : {std::pair{0.0, 1.0}, {-1.5, 2.0}}) {
      const double bump = height * std::exp(-(p.z - z) * (p.z - z) / 0.08);
      sample.value += bump;
      sample.gradient.z -= 2 * (p.z - z) / 0.08 * bump;
    }
    return sample;
  }
};

TEST(HapticStep, a_surface_that_gives_way_does_not_carry_the_proxy_past_the_next) {
  const Membranes membranes;
  Scene scene = scene_of({surface(TransferFunction({{0.1, 0}, {1, 1}, {2, 2.5}}), Datum::value)}, 8);
  for (const int most_halts : {16, 0}) {
    scene.subdivision.most_halts = most_halts;
    Hand hand(scene, membranes);
    // The first yields at 1 N, 2.5 mm deep; what it lets go of would pass the second, which holds 2.5 N.
    hand.stroke({0, 0, 3}, {0, 0, -3.5}, 4000);
    if (most_halts > 0) {
      EXPECT_GT(hand.proxy_mm().z, -1.5);
      EXPECT_EQ(hand.result.hold, HoldState::held);
    } else {
      EXPECT_LT(hand.proxy_mm().z, -2.0) << "without halts the second is missed: else this test shows nothing";
    }
    // At rest nothing moves, so nothing is halted.
    hand.move_to({0, 0, -3.5});
    hand.move_to({0, 0, -3.5});
    EXPECT_EQ(hand.result.halts, 0);
  }
}

TEST(HapticStep, a_probe_at_rest_gives_a_force_constant_to_the_last_bit) {
  const Ball ball;
  Hand hand(skin(), ball);
  hand.stroke({1, 2, 25}, {2, 3, 17}, 500);
  const Vec3 probe{2, 3, 17};
  for (int i = 0; i < 200; ++i) {
    hand.move_to(probe);
  }
  const Vec3 force = hand.result.force_n;
  EXPECT_GT(glm::length(force), 0.5);
  for (int i = 0; i < 10000; ++i) {
    hand.move_to(probe);
    ASSERT_EQ(hand.result.force_n, force) << i;
  }
}

TEST(HapticStep, the_same_path_gives_the_same_bits) {
  const Ball ball;
  Scene scene = skin();
  scene.modes.push_back(flow_mode("follow", 0.3));
  scene.modes.push_back(flow_mode("force", 0.2));
  Hand first(scene, ball), second(scene, ball);
  std::mt19937 random(1);
  std::normal_distribution<double> step(0, 0.3);
  Vec3 probe{0, 0, 22};
  for (int i = 0; i < 5000; ++i) {
    const double x = step(random), y = step(random), z = step(random);  // in this order with every compiler
    probe += Vec3(x, y, z - 0.002 * (probe.z - 18));
    first.move_to(probe);
    second.move_to(probe);
    ASSERT_EQ(first.result.force_n, second.result.force_n);
  }
}

TEST(HapticStep, each_part_of_a_tick_is_timed_and_none_of_it_twice) {
  const Ball ball;
  Scene scene = skin();
  scene.subdivision = {.step_mm = 0.1, .most = 8};
  const Plan plan = make_plan(scene, ball.available(), {});
  solver::Chain chain;
  Touch touch;
  const auto scratch = std::make_unique<StepScratch>();
  StepTimes all;
  for (int n = 0; n < 200; ++n) {
    const std::uint64_t before = clock_count();
    step(plan, ball, plan.workspace.to_device({0, 1, 23 - 0.03 * n}), touch, chain, *scratch);
    const std::uint64_t after = clock_count();
    const StepTimes& times = scratch->times;
    EXPECT_LE(times.map + times.sample + times.modes + times.solve, after - before) << n;
    all.map += times.map;
    all.sample += times.sample;
    all.modes += times.modes;
    all.solve += times.solve;
  }
  EXPECT_GT(all.map, 0U);
  EXPECT_GT(all.sample, 0U);
  EXPECT_GT(all.modes, 0U);
  EXPECT_GT(all.solve, 0U);
}

/// A tenth of a millisecond, in counts of the clock: longer than any part of a tick takes by itself.
std::uint64_t long_time() {
  static const auto counts = static_cast<std::uint64_t>(1e5 * counts_per_ns());
  return counts;
}

void take_long() noexcept {
  const std::uint64_t begun = clock_count();
  while (clock_count() - begun < long_time()) {
  }
}

class SlowBall final : public Ball {
 public:
  io::Sample sample(const io::Vec3& p, io::FieldSet wanted) const noexcept override {
    take_long();
    return Ball::sample(p, wanted);
  }
};

/// The least time of each part in some ticks of a hand at rest: what a busy machine adds to one is not in all of them.
StepTimes least_times(const Plan& plan, const io::FieldSource& source) {
  solver::Chain chain;
  Touch touch;
  const auto scratch = std::make_unique<StepScratch>();
  StepTimes least{.map = ~0ULL, .sample = ~0ULL, .modes = ~0ULL, .solve = ~0ULL};
  for (int n = 0; n < 20; ++n) {
    step(plan, source, Vec3(0), touch, chain, *scratch);
    const StepTimes& times = scratch->times;
    least = {.map = std::min(least.map, times.map),
             .sample = std::min(least.sample, times.sample),
             .modes = std::min(least.modes, times.modes),
             .solve = std::min(least.solve, times.solve)};
  }
  return least;
}

TEST(HapticStep, what_takes_long_is_told_as_the_part_that_it_is) {
  const Ball ball;
  Plan plan = make_plan(skin(), ball.available(), {});
  const StepTimes sampled = least_times(plan, SlowBall());
  EXPECT_GE(sampled.sample, long_time());
  for (const std::uint64_t other : {sampled.map, sampled.modes, sampled.solve}) EXPECT_LT(other, long_time());
  ModeType slow = *find_mode_type("friction");
  slow.place = [](const ActiveMode&, const Place&, PrimitiveList&) noexcept { take_long(); };
  for (ActiveMode& mode : plan.modes) mode.type = &slow;
  const StepTimes placed = least_times(plan, ball);
  EXPECT_GE(placed.modes, long_time());
  for (const std::uint64_t other : {placed.map, placed.sample, placed.solve}) EXPECT_LT(other, long_time());
}

TEST(HapticStep, shares_balance_the_coupling_and_are_named_by_the_scene_mode_that_made_them) {
  const Ball ball;
  Scene scene = skin();
  scene.modes.insert(scene.modes.begin(), friction(0));  // left out by the plan: indices stay those of the scene
  scene.modes.push_back(flow_mode("force", 0.2));
  Hand hand(scene, ball);
  hand.stroke({0, 1, 24}, {0, 1, 18}, 300);
  const StepResult& result = hand.result;
  ASSERT_EQ(result.primitives.size(), 3U);
  EXPECT_EQ(result.mode_of[0], 1);
  EXPECT_EQ(result.mode_of[1], 2);
  EXPECT_EQ(result.mode_of[2], 3);
  Vec3 sum(0);
  for (const Vec3& share : result.shares) {
    sum += share;
  }
  EXPECT_LE(glm::length(result.force_n - sum), 1e-9);
  EXPECT_LE(glm::length(result.shares[1]), 0.1 + 1e-12);
}

TEST(HapticStep, nothing_is_felt_outside_the_data_and_its_edge_is_no_boundary) {
  const Ball ball;
  Scene scene = scene_of({friction(0.1)});
  Hand hand(scene, ball);
  hand.stroke({0, 0, 50}, {0, 0, 41}, 100);
  EXPECT_EQ(hand.force(), Vec3(0));
  Hand surfaces(scene_of({surface(TransferFunction(1.0))}), ball);
  surfaces.stroke({0, 0, 50}, {0, 0, 30}, 1000);
  EXPECT_LE(glm::length(surfaces.force()), 1e-12);
}

TEST(HapticStep, a_probe_or_a_field_that_is_not_finite_is_refused_and_the_force_stays) {
  Ball ball;
  Scene scene = skin();
  scene.modes.push_back(flow_mode("force", 0.2));
  Hand hand(scene, ball);
  hand.stroke({0, 1, 24}, {0, 1, 18}, 300);
  const Vec3 force = hand.result.force_n;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e308}) {
    hand.move_to({0, bad, 18});
    EXPECT_NE(hand.result.outcome, solver::Outcome::solved) << bad;
    EXPECT_EQ(hand.result.force_n, force);
    if (std::isfinite(bad)) continue;  // so far away that it has no balance; the others are not tried
    EXPECT_EQ(hand.result.outcome, solver::Outcome::refused);
    EXPECT_EQ(hand.result.solver, nullptr);
    EXPECT_EQ(hand.result.iterations, 0);
    EXPECT_EQ(hand.result.error_bound, 0);
    EXPECT_TRUE(hand.result.primitives.empty());
  }
  hand.move_to({0, 1, 18});
  EXPECT_EQ(hand.result.outcome, solver::Outcome::solved);
  ball.broken = true;
  const Vec3 before = hand.result.force_n;
  hand.move_to({0, 1, 18});
  EXPECT_EQ(hand.result.outcome, solver::Outcome::refused);
  EXPECT_EQ(hand.result.force_n, before);
  ball.broken = false;
  hand.move_to({0, 1, 18});
  EXPECT_EQ(hand.result.outcome, solver::Outcome::solved);
}

TEST(HapticStep, a_rotated_and_scaled_workspace_feels_the_same_shape) {
  const Ball ball;
  const Vec3 axis = glm::normalize(Vec3(1, 2, -1));
  const Vec3 side = glm::normalize(glm::cross(axis, Vec3(0, 0, 1)));
  Workspace turned;
  turned.rotation = glm::dmat3(side, glm::cross(axis, side), axis);
  turned.center_mm = {3, -4, 5};
  turned.mm_per_m = 500;  // 0.5 mm of patient for 1 mm of hand: the same depth in the patient is felt twice as hard
  const Scene scene = scene_of({surface(TransferFunction({{0.4, 0}, {0.5, 2}}), Datum::value)});
  Hand plain(scene, ball), mapped(scene, ball, turned);
  plain.stroke({0, 1, 24}, {0, 1, 18.5}, 1000);
  mapped.stroke({0, 1, 24}, {0, 1, 18.5}, 1000);
  EXPECT_LE(glm::length(plain.force() / glm::length(plain.force()) - mapped.force() / glm::length(mapped.force())),
            2e-3);
  EXPECT_NEAR(glm::length(mapped.force()) / glm::length(plain.force()), 2.0, 0.05);
}

}  // namespace
}  // namespace palpate::modes
