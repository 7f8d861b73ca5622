// Changes of scene, data and workspace: ramped, never stepped, and the proxy moves with the data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <memory>
#include <vector>

#include "modes/testing/test_rig.h"
#include "testdata/analytic.h"

namespace palpate::modes {
namespace {

using testing::scene_of;
using testing::surface;

constexpr int ramp_ticks = 500;

testdata::AnalyticSource slab_at(double depth_mm) {
  // Inwards is up: along the device's y.
  return testdata::AnalyticSource(
      testdata::make_slab({0, 0, 1}, std::vector<testdata::Layer>{{depth_mm, testdata::soft_tissue_hu}}), 1.0);
}

Scene skin(double strength_n) {
  Mode friction;
  friction.type = "friction";
  friction.strength_n = TransferFunction(0.1);
  return scene_of({surface(TransferFunction({{-482, 0}, {-478, strength_n}}), Datum::value), friction});
}

struct Ramp {
  double largest_step_n = 0;
  Vec3 first_n{0}, last_n{0};
  Vec3 proxy_before_mm{0}, proxy_after_mm{0};  ///< patient space
};

/// Presses 3 mm deep (1.2 N) into `from`, then holds still while it changes to `to`, and on for as long again.
Ramp change(const SceneOnData& from, const SceneOnData& to) {
  solver::Chain chain;
  Touch touch;
  const auto scratch = std::make_unique<StepScratch>();
  const auto at = [&](double depth_mm) { return from.plan->workspace.to_device({0, 0, depth_mm}); };
  for (int i = 0; i <= 2000; ++i) {
    step(*from.plan, *from.source, at(-3 + 6 * i / 2000.0), touch, chain, *scratch);
  }
  Ramp ramp{.first_n = touch.force_n, .proxy_before_mm = touch.workspace.to_patient(touch.proxy_m)};
  Vec3 force = touch.force_n;
  for (int i = 0; i <= 2 * ramp_ticks; ++i) {
    const StepResult result =
        i <= ramp_ticks
            ? step({.from = from, .to = to, .part = static_cast<double>(i) / ramp_ticks}, at(3), touch, chain, *scratch)
            : step(*to.plan, *to.source, at(3), touch, chain, *scratch);
    EXPECT_EQ(result.outcome, solver::Outcome::solved) << i;
    ramp.largest_step_n = std::max(ramp.largest_step_n, glm::length(result.force_n - force));
    force = result.force_n;
  }
  ramp.last_n = force;
  ramp.proxy_after_mm = touch.workspace.to_patient(touch.proxy_m);
  return ramp;
}

Ramp change_scene(const Scene& from, const Scene& to, const Workspace& workspace = {}) {
  const auto source = slab_at(0);
  const Plan before = make_plan(from, source.available(), {});
  const Plan after = make_plan(to, source.available(), workspace);
  return change({&before, &source}, {&after, &source});
}

TEST(SceneChange, to_the_same_scene_is_not_felt) {
  const Ramp ramp = change_scene(skin(2), skin(2));
  EXPECT_NEAR(glm::length(ramp.first_n), 1.2, 0.01);
  EXPECT_LE(ramp.largest_step_n, 1e-12);
}

TEST(SceneChange, a_wall_that_is_switched_off_lets_go_within_the_ramp_and_never_steps) {
  const Ramp ramp = change_scene(skin(2), scene_of({}));
  EXPECT_GT(glm::length(ramp.first_n), 1.1);
  EXPECT_EQ(ramp.last_n, Vec3(0));
  EXPECT_LE(ramp.largest_step_n, 0.02);  // of a slew limit of 1 N/ms
}

TEST(SceneChange, a_stronger_wall_and_a_stiffer_coupling_come_in_by_the_ramp) {
  Scene stiff = skin(2.5);
  stiff.stiffness_n_per_m = 800;
  const Ramp ramp = change_scene(skin(2), stiff);
  EXPECT_NEAR(glm::length(ramp.last_n), 2 * glm::length(ramp.first_n), 0.05);
  EXPECT_LE(ramp.largest_step_n, 0.01);
}

TEST(SceneChange, the_proxy_moves_with_a_moved_turned_and_scaled_workspace) {
  Workspace moved;
  moved.center_mm = {0.5, -0.3, -0.4};
  moved.mm_per_m = 900;
  const double c = std::cos(0.3), s = std::sin(0.3);
  moved.rotation = moved.rotation * glm::dmat3(c, s, 0, -s, c, 0, 0, 0, 1);
  const Ramp ramp = change_scene(skin(2), skin(2), moved);
  EXPECT_LE(ramp.largest_step_n, 0.02);
  // The wall holds it at the same depth in the patient, wherever the hand is now.
  EXPECT_NEAR(ramp.proxy_after_mm.z, ramp.proxy_before_mm.z, 0.02);
  EXPECT_GT(glm::length(ramp.last_n), 0.3);
}

TEST(SceneChange, to_another_time_frame_moves_the_proxy_from_one_wall_to_the_other) {
  const auto before = slab_at(0), after = slab_at(1.5);
  const Plan plan = make_plan(skin(2), before.available(), {});
  const Ramp ramp = change({&plan, &before}, {&plan, &after});
  EXPECT_LE(ramp.largest_step_n, 0.05);
  EXPECT_NEAR(ramp.proxy_before_mm.z, 0.0, 0.02);
  EXPECT_NEAR(ramp.proxy_after_mm.z, 1.5, 0.3);
}

/// Each change of a session is as the first one was.
TEST(SceneChange, of_time_frames_one_after_the_other_moves_the_proxy_from_wall_to_wall) {
  solver::Chain chain;
  Touch touch;
  const auto scratch = std::make_unique<StepScratch>();
  const testdata::AnalyticSource frames[]{slab_at(0), slab_at(0.8), slab_at(1.6), slab_at(2.4)};
  const Plan plan = make_plan(skin(2), frames[0].available(), {});
  const auto at = [&](double depth_mm) { return plan.workspace.to_device({0, 0, depth_mm}); };
  for (int i = 0; i <= 2000; ++i) step(plan, frames[0], at(-3 + 7 * i / 2000.0), touch, chain, *scratch);
  Vec3 force = touch.force_n;
  for (std::size_t next = 1; next < std::size(frames); ++next) {
    for (int i = 0; i <= 2 * ramp_ticks; ++i) {
      const double part = static_cast<double>(i) / ramp_ticks;
      const SceneChange change{.from = {&plan, &frames[next - 1]}, .to = {&plan, &frames[next]}, .part = part};
      const StepResult result = part <= 1 ? step(change, at(4), touch, chain, *scratch)
                                          : step(plan, frames[next], at(4), touch, chain, *scratch);
      EXPECT_LE(glm::length(result.force_n - force), 0.05) << "to frame " << next << ", tick " << i;
      force = result.force_n;
    }
    EXPECT_NEAR(plan.workspace.to_patient(touch.proxy_m).z, 0.8 * static_cast<double>(next), 0.1) << next;
  }
}

/// The value rises down by 100 a mm, and has ripples that the gradient does not show: so the level of what is held is
/// not the value.
class Rippled final : public io::FieldSource {
 public:
  explicit Rippled(double more) : more_(more) {}
  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::gradient; }
  io::Sample sample(const io::Vec3& p, io::FieldSet) const noexcept override {
    return {.inside = true, .value = more_ - 100 * p.z + 20 * std::sin(3 * p.x), .gradient = {0, 0, -100}};
  }

 private:
  double more_;
};

TEST(SceneChange, on_the_same_data_the_level_goes_on_and_on_other_data_it_begins_with_the_value) {
  const Rippled before(0), after(40);
  const Scene scene = scene_of({surface(TransferFunction({{0, 0}, {10, 2}}), Datum::value)});
  for (const Rippled* to : {&before, &after}) {
    testing::Hand hand(scene, before);
    hand.stroke({0, 0, 2}, {0, 0, -2}, 1000);
    hand.stroke({0, 0, -2}, {1.5, 0, -2}, 1000);
    const HeldSurface held = hand.touch.contact.scan;
    ASSERT_EQ(held.hold, HoldState::held);
    ASSERT_GT(std::abs(held.level - held.value), 5) << "else this test shows nothing";
    solver::Chain chain;
    const auto scratch = std::make_unique<StepScratch>();
    Touch touch = hand.touch;
    const SceneOnData from{&hand.plan, &before};
    step({.from = from, .to = {&hand.plan, to}, .part = 0}, hand.plan.workspace.to_device({1.5, 0, -2}), touch, chain,
         *scratch);
    EXPECT_EQ(touch.leaving.scan.held_level, held.held_level) << "what is left is left as it was";
    const HeldSurface& now = touch.contact.scan;
    if (to == &before) {
      EXPECT_EQ(now.held_level, held.held_level);
      EXPECT_NEAR(now.level, held.level, 1e-3);
    } else {
      EXPECT_EQ(now.level, after.sample(now.place_mm, {}).value);
      EXPECT_EQ(now.held_level, now.level);
    }
  }
}

/// Nor is the second or the third, though the level of the wall that is pressed is not the value there.
TEST(SceneChange, to_the_same_scene_is_not_felt_however_often_it_comes) {
  const Rippled source(0);
  testing::Hand hand(scene_of({surface(TransferFunction({{0, 0}, {10, 2}}), Datum::value)}), source);
  hand.stroke({0, 0, 2}, {0, 0, -2}, 1000);
  hand.stroke({0, 0, -2}, {1.5, 0, -2}, 1000);
  for (int i = 0; i < 100; ++i) hand.move_to({1.5, 0, -2});
  const Vec3 probe = hand.plan.workspace.to_device({1.5, 0, -2}), force = hand.result.force_n;
  ASSERT_GT(glm::length(force), 0.5);
  solver::Chain chain({.capacity = most_primitives});
  const auto scratch = std::make_unique<StepScratch>();
  const SceneOnData same{&hand.plan, &source};
  for (int change = 0; change < 3; ++change) {
    for (int i = 1; i <= 2 * ramp_ticks; ++i) {
      const double part = static_cast<double>(i) / ramp_ticks;
      const StepResult result = part <= 1
                                    ? step({.from = same, .to = same, .part = part}, probe, hand.touch, chain, *scratch)
                                    : step(hand.plan, source, probe, hand.touch, chain, *scratch);
      ASSERT_LE(glm::distance(result.force_n, force), 1e-9) << "change " << change << ", tick " << i;
    }
  }
}

TEST(SceneChange, has_room_for_all_that_two_scenes_can_place) {
  const Rippled source(0);
  const auto walls = [](double strength_n) {
    std::vector<Mode> modes(Scene::most_modes, surface(TransferFunction(strength_n), Datum::value, Side::both));
    return scene_of(modes);
  };
  const Plan from = make_plan(walls(0.01), source.available(), {}), to = make_plan(walls(0.02), source.available(), {});
  solver::Chain chain({.capacity = most_primitives});
  Touch touch;
  const auto scratch = std::make_unique<StepScratch>();
  const StepResult result =
      step({.from = {&from, &source}, .to = {&to, &source}, .part = 0.25}, Vec3(0), touch, chain, *scratch);
  EXPECT_EQ(result.outcome, solver::Outcome::solved);
  ASSERT_EQ(result.primitives.size(), 2 * 2 * Scene::most_modes);
  ASSERT_EQ(result.shares.size(), result.primitives.size());
  for (std::size_t n = 0; n < result.primitives.size(); ++n) {
    const bool is_left = n >= 2 * Scene::most_modes;
    EXPECT_EQ(result.mode_of[n], (n / 2 % Scene::most_modes) | (is_left ? of_scene_left : 0U)) << n;
    EXPECT_DOUBLE_EQ(result.primitives[n].strength, is_left ? 0.75 * 0.01 : 0.25 * 0.02) << n;
  }
}

TEST(Workspace, between_two_of_them_lies_a_similarity_and_the_ends_are_exact) {
  Workspace from, to;
  to.center_mm = {10, 20, 30};
  to.mm_per_m = 4000;
  to.rotation = glm::dmat3(0, 1, 0, 0, 0, 1, 1, 0, 0);
  EXPECT_TRUE(between(from, to, 0) == from);
  EXPECT_TRUE(between(from, to, 1) == to);
  const Workspace half = between(from, to, 0.5);
  EXPECT_DOUBLE_EQ(half.mm_per_m, 2000);
  EXPECT_EQ(half.center_mm, Vec3(5, 10, 15));
  const glm::dmat3 unit = glm::transpose(half.rotation) * half.rotation;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(unit[i][i], 1, 1e-15);
    EXPECT_NEAR(unit[i][(i + 1) % 3], 0, 1e-15);
  }
}

}  // namespace
}  // namespace palpate::modes
