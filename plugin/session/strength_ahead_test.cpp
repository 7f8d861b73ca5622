// What is told of a boundary before and after a stroke, against the force that the stroke met: on plates of a voxel or
// two, on what lies behind them, and on walls that the stroke never broke.
#include "plugin/session/strength_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/stroke.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using testdata::HalfSpace;

constexpr double tolerance = 0.15;  // of the force: a hand tells a tenth

const modes::Scene& bone() {
  static const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "name": "bone",
          "strength_n": {"of": "gradient_per_mm", "nodes": [[15, 0], [80, 2.5]]},
          "gates": [{"of": "value", "nodes": [[250, 0], [300, 1]]}]}]})",
      "bone");
  return scene;
}

/// With a gradient so sharp that it tells a plate from a wall 2 mm behind, which takes more.
const modes::Scene& sharp_bone() {
  static const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "gradient_scale_mm": 0.8, "modes": [{"type": "surface", "name": "bone",
          "strength_n": {"of": "gradient_per_mm", "nodes": [[15, 0], [600, 2.5]]},
          "gates": [{"of": "value", "nodes": [[250, 0], [300, 1]]}]}]})",
      "sharp bone");
  return scene;
}

struct Press {
  PreparedScene felt;
  glm::dvec3 inward, start, end;
  std::vector<StrokePoint> stroke;
};

/// Through a plate of bone in soft tissue, and as far as `beyond_mm` behind its near side, on which the origin lies;
/// a wall of bone begins `gap_mm` behind the plate.
Press press_through(const modes::Scene& scene, double width_mm, double gap_mm, double tilt_degrees, double speed,
                    double beyond_mm) {
  const double tilt = tilt_degrees * M_PI / 180;
  const glm::dvec3 inward(std::sin(tilt), 0, -std::cos(tilt));
  testdata::Phantom phantom{.background = testdata::soft_tissue_hu, .bodies = {}};
  phantom.bodies.push_back({HalfSpace{-inward, 0}, testdata::bone_hu});
  phantom.bodies.push_back({HalfSpace{-inward, -width_mm}, testdata::soft_tissue_hu});
  phantom.bodies.push_back({HalfSpace{-inward, -width_mm - gap_mm}, testdata::bone_hu});
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(40)}), {.noise = 5}));
  Press press{.felt = prepare(scene, volume, glm::dvec3(0.1)), .inward = inward, .start = {}, .end = {}, .stroke = {}};
  const glm::dvec3 aside = 0.3 * glm::cross(inward, glm::dvec3(0, 1, 0)) + glm::dvec3(0, 0.4, 0);
  press.start = aside - 8.0 * inward;
  press.end = aside + beyond_mm * inward;
  press.stroke = run_stroke(*press.felt.plan, *press.felt.source, press.start, press.end, speed);
  return press;
}

struct Broken {
  std::size_t first = 0, at = 0;  ///< points at which more than met_n was felt, and at which half of it was gone
  double peak_n = 0;
};

Broken first_break(const std::vector<StrokePoint>& stroke) {
  Broken broken;
  for (broken.at = 0; broken.at < stroke.size(); ++broken.at) {
    const double force = glm::length(stroke[broken.at].force_n);
    if (broken.peak_n <= met_n) broken.first = broken.at;
    if (broken.peak_n > met_n && force < 0.5 * broken.peak_n) break;
    broken.peak_n = std::max(broken.peak_n, force);
  }
  return broken;
}

TEST(StrengthAhead, IsWhatABrokenPlateHasTaken) {
  for (const double tilt : {0.0, 20.0, 45.0}) {
    for (const double speed : {1.0, 10.0, 30.0}) {
      for (const double width : {1.0, 2.0}) {
        SCOPED_TRACE(::testing::Message() << width << " mm, " << tilt << " degrees, " << speed << " mm/s");
        const Press press = press_through(bone(), width, 30, tilt, speed, 11);
        std::vector<Contact> contacts = contacts_of(press.stroke, *press.felt.plan, met_n);
        add_strengths(contacts, press.stroke, *press.felt.plan, *press.felt.source);
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_LT(contacts[0].last + 1, press.stroke.size()) << "the plate has not let go";
        EXPECT_NEAR(contacts[0].peak_n, contacts[0].strength_n, tolerance * contacts[0].strength_n);
      }
    }
  }
}

TEST(StrengthAhead, IsToldFromTheFirstTouchOnAndNotOfTheWallBehind) {
  for (const double tilt : {0.0, 20.0, 45.0}) {
    for (const double gap : {2.0, 2.5, 30.0}) {
      SCOPED_TRACE(::testing::Message() << gap << " mm to the wall, " << tilt << " degrees");
      const Press press = press_through(sharp_bone(), 1, gap, tilt, 5, 5);
      const Broken plate = first_break(press.stroke);
      ASSERT_LT(plate.at, press.stroke.size()) << "the plate has not let go";
      std::size_t told = 0;
      for (std::size_t n = plate.first; n < plate.at; n += 10, ++told) {
        const double ahead = strength_ahead_n(press.felt.plan->modes.front(), *press.felt.plan, *press.felt.source,
                                              press.stroke[n].proxy_mm, press.inward);
        EXPECT_NEAR(ahead, plate.peak_n, tolerance * plate.peak_n) << "tick " << n << ", broken at " << plate.at;
      }
      EXPECT_GT(told, 5U);
    }
  }
}

TEST(StrengthAhead, OfAWallThatIsPressedLightlyIsAllThatItCanTake) {
  const Press press = press_through(bone(), 20, 1, 10, 20, 1);
  std::vector<Contact> contacts = contacts_of(press.stroke, *press.felt.plan, met_n);
  ASSERT_EQ(contacts.size(), 1U);
  ASSERT_LT(contacts[0].peak_n, 1.5);
  add_strengths(contacts, press.stroke, *press.felt.plan, *press.felt.source);
  EXPECT_NEAR(contacts[0].strength_n, 2.5, 0.05);
  EXPECT_EQ(strength_to_text(contacts[0]), "");
}

TEST(StrengthAhead, IsNothingOnTheWayOut) {
  const Press press = press_through(bone(), 20, 1, 0, 20, 1);
  const modes::ActiveMode& surface = press.felt.plan->modes.front();
  const auto ahead = [&](const glm::dvec3& direction) {
    return strength_ahead_n(surface, *press.felt.plan, *press.felt.source, -1.0 * press.inward, direction);
  };
  EXPECT_GT(ahead(press.inward), 2.4);
  EXPECT_EQ(ahead(-press.inward), 0);
}

/// The far side of a plate is as steep as the near one, and resists nothing on the way in.
TEST(StrengthAhead, OfAPlateLeavesItsFarSideOut) {
  const Press press = press_through(sharp_bone(), 1, 30, 0, 5, 5);
  const modes::ActiveMode& surface = press.felt.plan->modes.front();
  const double near =
      strength_ahead_n(surface, *press.felt.plan, *press.felt.source, -1.0 * press.inward, press.inward);
  EXPECT_EQ(strength_ahead_n(surface, *press.felt.plan, *press.felt.source, 0.6 * press.inward, press.inward), 0);
  EXPECT_NEAR(near, first_break(press.stroke).peak_n, tolerance * near);
}

/// Beyond the scan there is nothing that could resist, whichever way a boundary acts and however strong it is.
TEST(StrengthAhead, IsNothingOutsideTheScan) {
  const modes::Scene both = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "side": "both", "strength_n": 1.5}]})", "both");
  const modes::Plan plan = modes::make_plan(both, io::FieldSet::value | io::FieldSet::gradient, {});
  io::Sample sample;
  sample.gradient = {0, 0, 100};
  sample.inside = true;
  EXPECT_EQ(strength_against_n(plan.modes.at(0), sample, {0, 0, 1}), 1.5);
  EXPECT_EQ(strength_against_n(plan.modes.at(0), sample, {0, 0, -1}), 1.5);
  sample.inside = false;
  EXPECT_EQ(strength_against_n(plan.modes.at(0), sample, {0, 0, 1}), 0);
}

}  // namespace
}  // namespace palpate::plugin
