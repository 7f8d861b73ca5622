/// A stroke's numbers against the same steps of the balance made beside it, and the limits of its length.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "plugin/session/stroke.h"
#include "plugin/testing/session_rig.h"
#include "solver/chain.h"

namespace palpate::plugin {
namespace {

/// Who pushes most is the mode of the longest share, and what it pushes with is its primitive; where nothing pushes
/// there is neither.
TEST(StrokeSteps, SayWhoPushesMostAndHowItWasSolved) {
  const auto source = testing::slab();
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const modes::Scene more = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": 0},
          {"type": "landmark", "shape": "point", "strength_n": 0.3, "position_mm": [1, 2, 5]},
          {"type": "landmark", "shape": "plane", "strength_n": 0.6, "position_mm": [0, 0, -3], "direction": [0, 0, 1]}]})",
      "more");
  scene.modes.insert(scene.modes.end(), more.modes.begin(), more.modes.end());
  const auto run = [&](const modes::Scene& felt) {
    modes::Workspace workspace;
    workspace.rotation = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    workspace.center_mm = {1, -2, 3};
    workspace.mm_per_m = 1300;
    const modes::Plan plan = modes::make_plan(felt, source->available(), workspace);
    const glm::dvec3 from(2, 1, 12), to(-1, 3, -14);
    const std::vector<StrokePoint> stroke = run_stroke(plan, *source, from, to, 37);
    solver::Chain chain({.solvers = plan.solvers});
    const auto scratch = std::make_unique<modes::StepScratch>();
    modes::Touch touch;
    std::map<int, int> pushed;  // by mode; -1: none
    const double last = static_cast<double>(stroke.size()) - 1;
    for (std::size_t n = 0; n < stroke.size(); ++n) {
      const glm::dvec3 at = from + (static_cast<double>(n) / last) * (to - from);
      const modes::StepResult step = modes::step(plan, *source, plan.workspace.to_device(at), touch, chain, *scratch);
      EXPECT_EQ(stroke[n].solver, step.solver);
      EXPECT_EQ(stroke[n].error_bound_m, step.error_bound);
      EXPECT_LT(glm::distance(stroke[n].proxy_mm, plan.workspace.to_patient(step.proxy_m)), 1e-12);
      double longest = 0;
      int mode = -1, primitive = -1;
      for (std::size_t of = 0; of < step.shares.size(); ++of) {
        if (glm::length(step.shares[of]) <= longest) continue;
        longest = glm::length(step.shares[of]);
        mode = step.mode_of[of];
        primitive = static_cast<int>(step.primitives[of].type);
      }
      EXPECT_EQ(stroke[n].boundary ? static_cast<int>(*stroke[n].boundary) : -1, mode) << n;
      EXPECT_EQ(stroke[n].primitive ? static_cast<int>(*stroke[n].primitive) : -1, primitive) << n;
      for (const double mm : stroke[n].distance_mm) EXPECT_EQ(mm, 0) << "no structure is read";
      ++pushed[mode];
    }
    return pushed;
  };
  EXPECT_GE(run(scene).size(), 3U) << "each of several pushes most somewhere";
  const modes::Scene weak = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": {"of": "gradient_per_mm",
          "nodes": [[20, 0], [60, 1]]}}]})",
      "weak");
  EXPECT_GT(run(weak)[-1], 100) << "in the air nothing pushes";
}

/// From one tick to ten million.
TEST(StrokeSteps, HaveAtLeastOneTickAndAtMostTenMillion) {
  const auto source = testing::slab();
  const modes::Plan plan = modes::make_plan(modes::load_scene("ct-bone"), source->available(), {});
  EXPECT_EQ(run_stroke(plan, *source, {0, 0, 9}, {0, 0, 8.999}, 1).size(), 2U);
  EXPECT_EQ(run_stroke(plan, *source, {0, 0, 9}, {0, 0, 8.9999}, 1).size(), 2U) << "a part of a tick is one";
  EXPECT_EQ(run_stroke(plan, *source, {0, 0, 9}, {0, 0, 8.75}, 100).size(), 4U);
  const auto refusal = [&](const glm::dvec3& to, double speed) -> std::string {
    try {
      run_stroke(plan, *source, {0, 0, 9}, to, speed);
      return "run";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal({0, 0, 9}, 8), "a stroke of 0 mm at 8 mm/s would have 0 ticks; from one to 10000000 can be run");
  EXPECT_EQ(refusal({0, 0, -10000992}, 1000),
            "a stroke of 10001001 mm at 1000 mm/s would have 10001001 ticks; from one to 10000000 can be run");
  EXPECT_NE(refusal({0, 0, 8}, 0), "run");
  EXPECT_NE(refusal({0, 0, 8}, -1), "run");
  EXPECT_NE(refusal({0, 0, std::nan("")}, 1), "run");
}

/// Whoever pushes without being a surface of the plan makes no contact: also a mode that the plan left out.
TEST(StrokeSteps, OnlyASurfaceOfThePlanMakesAContact) {
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": 1, "enabled": false}, {"type": "surface", "strength_n": 1},
          {"type": "friction", "strength_n": 1}]})",
      "test");
  const modes::Plan plan = modes::make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, {});
  for (const std::size_t pushing : {0U, 1U, 2U, 7U}) {
    std::vector<StrokePoint> stroke(5);
    for (StrokePoint& point : stroke) {
      point.boundary = pushing;
      point.force_n = {0, 0, 1};
    }
    EXPECT_EQ(contacts_of(stroke, plan, met_n).size(), pushing == 1 ? 1U : 0U) << pushing;
  }
}

/// Each contact gets the strengths of its own mode, in whatever order they are met.
TEST(StrokeSteps, EachContactHasTheStrengthsOfItsOwnMode) {
  const auto source = testing::slab();
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "friction", "strength_n": 0.02},
          {"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [120, 0.7], [400, 1.9]]},
           "gates": [{"of": "value", "nodes": [[-500, 1], [60, 1], [70, 0]]}]},
          {"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [100, 1.1], [150, 2.5]]},
           "gates": [{"of": "value", "nodes": [[60, 0], [70, 1]]}]}]})",
      "test");
  const modes::Plan plan = modes::make_plan(scene, source->available(), {});
  const std::vector<StrokePoint> stroke = run_stroke(plan, *source, {0, 0, 9}, {0, 0, -16}, 20);
  std::vector<Contact> contacts = contacts_of(stroke, plan, met_n);
  add_strengths(contacts, stroke, plan, *source);
  const auto first_of = [&](std::size_t boundary) {
    const auto found = std::ranges::find(contacts, boundary, &Contact::boundary);
    EXPECT_NE(found, contacts.end());
    return found == contacts.end() ? Contact() : *found;
  };
  const Contact skin = first_of(1), bone = first_of(2);
  EXPECT_EQ(skin.full_strength_n, 1.9);
  EXPECT_EQ(bone.full_strength_n, 2.5);
  // A Gaussian edge of 1.5 mm is steepest in its middle, by its step over sqrt(2 pi) 1.5 mm.
  const double per_mm[] = {1040 / (std::sqrt(2 * M_PI) * 1.5), 960 / (std::sqrt(2 * M_PI) * 1.5)};
  EXPECT_NEAR(skin.strength_n, 0.7 + (per_mm[0] - 120) / 280 * 1.2, 0.02);
  EXPECT_NEAR(bone.strength_n, 2.5, 0.02) << per_mm[1];
}

}  // namespace
}  // namespace palpate::plugin
