// The script of a hand that presses: how hard it presses, felt by a session, against what was wanted of it.
#include "plugin/session/press_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/simulated/simulated_hand.h"
#include "plugin/session/stroke.h"
#include "plugin/testing/session_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;

/// 0.6 of what the first boundary takes, whatever a millimeter of hand is in the patient and however stiff the
/// coupling: while it rests on the boundary, and after it has slid along it.
TEST(PressPath, PressesWithThreeFifthsOfWhatTheBoundaryTakes) {
  constexpr double strength_n = 1.5;
  for (const double scale : {0.5, 1.0, 2.5}) {
    for (const double stiffness_n_per_m : {300.0, 600.0}) {
      modes::Scene scene = modes::scene_from_json(
          R"({"version": 1, "modes": [{"type": "surface", "strength_n": {"of": "gradient_per_mm",
              "nodes": [[20, 0], [60, 1.5]]}}]})",
          "test");
      scene.stiffness_n_per_m = stiffness_n_per_m;
      // So sharp that the proxy hardly sinks into the edge while the force rises.
      const auto source = std::make_shared<testdata::AnalyticSource>(
          testdata::make_slab({0, 0, -1}, std::vector<testdata::Layer>{{0, testdata::soft_tissue_hu}}), 0.2);
      modes::Workspace workspace;
      workspace.mm_per_m = 1000 * scale;
      const auto plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), workspace));
      const PressPath path = make_press_path(*plan, *source, {0, 0, 10}, {0, 0, -20});
      EXPECT_LT(glm::distance(path.inward, glm::dvec3(0, 0, -1)), 1e-12);
      std::vector<device::Waypoint> hand;
      for (const PathPoint& point : path.hand) {
        hand.push_back({point.time_s, plan->workspace.to_device(point.position_mm), 0});
      }
      Session session({.plan = plan, .source = source, .limits = {}}, stylus(hand));
      double resting_n = 0, slid_n = 0;
      for (int n = 0; n < 6500; ++n) {
        const double sent_n = glm::length(vector_of(session.tick().sent_n));
        if (n >= 2500 && n < 3000) resting_n += sent_n / 500;
        if (n >= 6200) slid_n += sent_n / 300;
      }
      // The arm's dry friction of 0.06 N takes up its part.
      EXPECT_NEAR(resting_n, 0.6 * strength_n, 0.1) << scale << " " << stiffness_n_per_m;
      EXPECT_NEAR(slid_n, 0.6 * strength_n, 0.1) << scale << " " << stiffness_n_per_m;
    }
  }
}

/// On two boundaries, tilted against the stroke, every waypoint is known: the hand stops before the first, presses on
/// it, slides along it to the patient's left, goes back, through the second, and out.
TEST(PressPath, IsTheScriptThatItsNumbersSay) {
  constexpr double strength_n = 1.5, tilt = 0.3, apart_mm = 10;
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "side": "both", "strength_n": {"of": "gradient_per_mm",
          "nodes": [[20, 0], [60, 1.5]]}}]})",
      "test");
  const auto source = std::make_shared<testdata::AnalyticSource>(
      testdata::make_slab({std::sin(tilt), 0, -std::cos(tilt)},
                          std::vector<testdata::Layer>{{0, testdata::soft_tissue_hu}, {apart_mm, testdata::bone_hu}}),
      0.2);
  modes::Workspace workspace;
  workspace.mm_per_m = 1500;
  const modes::Plan plan = modes::make_plan(scene, source->available(), workspace);
  const PressPath path = make_press_path(plan, *source, {3, 0, 10}, {3, 0, -20});
  EXPECT_EQ(path.boundaries, std::vector<std::size_t>{0}) << "each once";
  EXPECT_NEAR(path.contact_mm.z, 3 * std::tan(tilt), 0.5);
  const double hand_mm_per_n = workspace.mm_per_m / device::HandModel{}.stiffness;
  const double press_mm = 0.6 * strength_n * (hand_mm_per_n + workspace.mm_per_m / scene.stiffness_n_per_m);
  const double through_mm = apart_mm / std::cos(tilt) + 2 + strength_n * hand_mm_per_n;
  const double slid_mm = press_mm - 12 * std::tan(tilt);
  struct Wanted {
    double time_s, depth_mm, left_mm;
  };
  const std::vector<Wanted> wanted{{0, -8, 0},          {1, -8, 0},       {2, press_mm, 0},   {3, press_mm, 0},
                                   {4.5, slid_mm, 12},  {6, press_mm, 0}, {6.5, press_mm, 0}, {9, through_mm, 0},
                                   {10, through_mm, 0}, {11.5, -8, 0},    {12, -8, 0}};
  ASSERT_EQ(path.hand.size(), wanted.size());
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    const glm::dvec3 way = path.hand[n].position_mm - path.contact_mm;
    EXPECT_EQ(path.hand[n].time_s, wanted[n].time_s);
    EXPECT_NEAR(-way.z, wanted[n].depth_mm, 0.03 * std::abs(wanted[n].depth_mm) + 0.1) << n;
    EXPECT_NEAR(way.x, wanted[n].left_mm, 1e-9) << n;
    EXPECT_NEAR(way.y, 0, 1e-9) << n;
  }
}

/// At its deepest the hand pulls with what the last boundary takes 2 mm beyond it, whatever the first one takes.
TEST(PressPath, AimsThroughTheLastBoundaryHoweverStrongItIs) {
  constexpr double apart_mm = 10, weak_n = 1, strong_n = 2.5;
  // A small step of the value takes 1 N, and a large one 2.5 N.
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "side": "both", "strength_n": {"of": "gradient_per_mm",
          "nodes": [[20, 0], [60, 1], [3000, 1], [6000, 2.5]]}}]})",
      "test");
  modes::Workspace workspace;
  workspace.mm_per_m = 1000;
  struct Case {
    double first_step_hu, last_step_hu, last_n;
  };
  for (const Case& one :
       {Case{1000, 1000, weak_n}, Case{1000, 5000, strong_n}, Case{5000, 1000, weak_n}, Case{5000, 5000, strong_n}}) {
    const double first_hu = -1000 + one.first_step_hu;
    const auto source = std::make_shared<testdata::AnalyticSource>(
        testdata::make_slab({0, 0, -1},
                            std::vector<testdata::Layer>{{0, first_hu}, {apart_mm, first_hu + one.last_step_hu}}),
        0.2);
    const modes::Plan plan = modes::make_plan(scene, source->available(), workspace);
    const PressPath path = make_press_path(plan, *source, {0, 0, 10}, {0, 0, -20});
    const double wanted_mm = apart_mm + 2 + one.last_n * workspace.mm_per_m / device::HandModel{}.stiffness;
    for (const std::size_t deepest : {7U, 8U}) {
      EXPECT_NEAR(path.contact_mm.z - path.hand.at(deepest).position_mm.z, wanted_mm, 0.03 * wanted_mm + 0.1)
          << one.first_step_hu << " " << one.last_step_hu;
    }
  }
}

struct Pressed {
  modes::Plan plan;
  std::shared_ptr<const io::FieldSource> source;
};

/// A surface that takes so much, on a phantom.
Pressed pressed_on(const testdata::Phantom& phantom, double strength_n) {
  modes::Scene scene =
      modes::scene_from_json(R"({"version": 1, "modes": [{"type": "surface", "strength_n": 1}]})", "test");
  scene.modes[0].strength_of = modes::Datum::gradient_magnitude;
  scene.modes[0].strength_n = modes::TransferFunction({{20, 0}, {60, strength_n}});
  const auto source = std::make_shared<testdata::AnalyticSource>(phantom, 0.2);
  return {modes::make_plan(scene, source->available(), {}), source};
}

/// Whichever way it presses, it slides across that way, 12 mm to the patient's left as far as that goes across; along
/// the patient's left or right it slides towards the head.
TEST(PressPath, SlidesAcrossItsWayToTheLeft) {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> ways{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  for (const double x : {-0.91, -0.89, 0.89, 0.91}) ways.push_back({x, std::sqrt(1 - x * x), 0});
  for (int n = 0; n < 8; ++n)
    ways.push_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
  for (const glm::dvec3& inward : ways) {
    const Pressed on =
        pressed_on(testdata::make_slab(inward, std::vector<testdata::Layer>{{0, testdata::soft_tissue_hu}}), 1.2);
    const PressPath path = make_press_path(on.plan, *on.source, -6.0 * inward, 3.0 * inward);
    EXPECT_LT(glm::distance(path.inward, inward), 1e-12);
    EXPECT_LT(glm::length(path.contact_mm), 1);
    const glm::dvec3 side = std::abs(inward.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 across = glm::normalize(glm::cross(glm::cross(inward, side), inward));
    const glm::dvec3 slid = path.hand.at(4).position_mm - path.hand.at(3).position_mm;
    // On a flat boundary the slide is as deep as the press, to a tick of the stroke.
    const double deeper_mm = glm::dot(slid, inward);
    EXPECT_LT(std::abs(deeper_mm), 0.051);
    EXPECT_LT(glm::distance(slid - deeper_mm * inward, 12.0 * across), 1e-6)
        << inward.x << " " << inward.y << " " << inward.z;
    EXPECT_GE(glm::dot(slid, side), 0);
  }
}

/// Where the boundary ends beside the way, the slide goes on as deep as the press.
TEST(PressPath, SlidesOnWhereTheBoundaryEnds) {
  const Pressed on = pressed_on(testdata::make_sphere(8), 1.2);
  const PressPath path = make_press_path(on.plan, *on.source, {0, 0, 16}, {0, 0, -1});
  EXPECT_NEAR(path.contact_mm.z, 8, 0.5);
  EXPECT_LT(glm::distance(path.hand.at(4).position_mm - path.hand.at(3).position_mm, glm::dvec3(12, 0, 0)), 1e-9);
}

/// A boundary is met where it takes more than 0.05 N: at that point of a stroke of 50 mm/s.
TEST(PressPath, MeetsWhatTakesMoreThanATwentiethOfANewton) {
  const auto slab_below = testdata::make_slab({0, 0, -1}, std::vector<testdata::Layer>{{0, testdata::soft_tissue_hu}});
  for (const double strength_n : {0.06, 0.09, 1.0}) {
    const Pressed on = pressed_on(slab_below, strength_n);
    const PressPath path = make_press_path(on.plan, *on.source, {1, 2, 7}, {1, 2, -7});
    const std::vector<StrokePoint> stroke = run_stroke(on.plan, *on.source, {1, 2, 7}, {1, 2, -7}, 50);
    const auto met =
        std::ranges::find_if(stroke, [](const StrokePoint& one) { return glm::length(one.force_n) > 0.05; });
    ASSERT_NE(met, stroke.end());
    EXPECT_EQ(path.contact_mm, met->position_mm) << strength_n;
  }
  try {
    const Pressed on = pressed_on(slab_below, 0.04);
    make_press_path(on.plan, *on.source, {1, 2, 7}, {-1.25, 2, -7});
    FAIL() << "met";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "nothing can be felt with this scene between 1.0, 2.0, 7.0 and -1.2, 2.0, -7.0 mm: choose another "
                 "stroke with --from and --to, or another scene");
  }
}

}  // namespace
}  // namespace palpate::plugin
