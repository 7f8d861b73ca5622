// The script of a hand that presses: how hard it presses, felt by a session, against what was wanted of it.
#include "plugin/session/press_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

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

}  // namespace
}  // namespace palpate::plugin
