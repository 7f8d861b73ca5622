#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "io/filter.h"
#include "modes/scene/scene.h"
#include "solver/text/testing/not_finite.h"

/// What a scene may not have, however it was made.
namespace palpate::modes {
namespace {

using ::testing::StartsWith;

/// A sound scene that has everything that is checked.
Scene made_by_a_program() {
  Scene scene;
  scene.tissues = {{.name = "air", .low = -2000, .high = -400, .softness = 100},
                   {.name = "skin", .low = -400, .high = 200, .softness = 600}};
  scene.structures = {{.name = "liver", .file = "a.dcm", .segment = "1", .margin_mm = 2.0},
                      {.name = "aorta", .file = "a.dcm", .segment_number = 2}};
  scene.modes.resize(2);
  scene.modes[0] = {.type = "surface", .name = "s", .strength_n = TransferFunction(1.0), .from = "air", .to = "skin"};
  scene.modes[1] = {.type = "keep_out", .strength_n = TransferFunction(1.0), .structure = "liver"};
  scene.modes[1].gates = {{.of = Datum::distance, .factor = TransferFunction(1.0), .structure = "aorta"}};
  return scene;
}

std::string refused(const Scene& scene) {
  try {
    validate(scene);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

/// Those who make a scene by themselves get no refusal of the text's reader.
TEST(SceneChecks, a_scene_that_a_program_made_is_checked_too) {
  ASSERT_EQ(refused(made_by_a_program()), "accepted");
  struct Spoilt {
    const char* refusal;
    void (*spoil)(Scene& scene);
  };
  const Spoilt all[]{
      {"stiffness_n_per_m: 0 is not a number above 0; it is in newtons per meter",
       [](Scene& s) { s.stiffness_n_per_m = 0; }},
      {"limits.force_limit_n: -1 is not a number above 0; it is in newtons", [](Scene& s) { s.limits.force_n = -1; }},
      {"limits.slew_limit_n_per_ms: nan is not a number above 0; it is in newtons per millisecond",
       [](Scene& s) { s.limits.slew_n_per_ms = nan; }},
      {"limits.ramp_s: 0 is not a number above 0; it is in seconds", [](Scene& s) { s.limits.ramp_s = 0; }},
      {"limits.speed_limit_m_per_s: inf is not a number above 0; it is in meters per second",
       [](Scene& s) { s.limits.speed_m_per_s = infinity; }},
      {"workspace.center_mm: is not finite", [](Scene& s) { s.workspace.center_mm = Vec3(0, nan, 0); }},
      {"workspace.scale: 0 is not a number above 0; it is in mm of patient for one mm of hand",
       [](Scene& s) { s.workspace.scale = 0; }},
      {"workspace.rotation: is not finite", [](Scene& s) { s.workspace.rotation[2].x = infinity; }},
      {"workspace.rotation: its axes are not of unit length and at right angles",
       [](Scene& s) { s.workspace.rotation[1] = s.workspace.rotation[0]; }},
      {"workspace.rotation: is a mirror image: right would be left", [](Scene& s) { s.workspace.rotation[1] *= -1; }},
      {"solvers: all are switched off", [](Scene& s) { s.solvers = {}; }},
      {"subdivision.step_mm: 0 is not a number above 0; it is in mm of patient",
       [](Scene& s) { s.subdivision.step_mm = 0; }},
      {"subdivision.proxy_step_mm: 0 is not a number above 0; it is in mm of patient",
       [](Scene& s) { s.subdivision.proxy_step_mm = 0; }},
      {"subdivision.most: 0 is not between 1 and 1000", [](Scene& s) { s.subdivision.most = 0; }},
      {"subdivision.most: 1001 is not between 1 and 1000", [](Scene& s) { s.subdivision.most = 1001; }},
      {"subdivision.most_halts: -1 is not between 0 and 1000", [](Scene& s) { s.subdivision.most_halts = -1; }},
      {"subdivision.most_halts: 1001 is not between 0 and 1000", [](Scene& s) { s.subdivision.most_halts = 1001; }},
      {"filter.width: a median of 4 voxels is not offered; give 3 or 5",
       [](Scene& s) { s.filter = {.type = io::find_filter_type("median"), .width = 4}; }},
      {"gradient_scale_mm: 0 is not a number above 0; it is in mm", [](Scene& s) { s.gradient_scale_mm = 0; }},
      {"tissues[1].name: is missing", [](Scene& s) { s.tissues[1].name.clear(); }},
      {"tissues[1].low: has to be below high", [](Scene& s) { s.tissues[1].low = s.tissues[1].high; }},
      {"tissues[1].low: has to be below high", [](Scene& s) { s.tissues[1].high = nan; }},
      {"tissues[2].low: has to be below high", [](Scene& s) { s.tissues.push_back({.name = "bone"}); }},
      {"tissues[2].softness: 0 is not above 0 and at most high - low",
       [](Scene& s) { s.tissues.push_back({.name = "bone", .low = 200, .high = 900}); }},
      {"tissues[1].softness: 601 is not above 0 and at most high - low", [](Scene& s) { s.tissues[1].softness = 601; }},
      {"tissues[1].color: \"#0072bg\" is not a color such as \"#0072b2\"",
       [](Scene& s) { s.tissues[1].color = "#0072bg"; }},
      {"tissues[2].name: \"air\" is used twice", [](Scene& s) { s.tissues.push_back(s.tissues[0]); }},
      {"structures[0].name: is missing",
       [](Scene& s) {
         s.structures[0].name.clear();
         s.modes.clear();
       }},
      {"structures[1].file: is missing", [](Scene& s) { s.structures[1].file.clear(); }},
      {"structures[1].segment: is missing", [](Scene& s) { s.structures[1].segment_number.reset(); }},
      {"structures[0].margin_mm: 0 is not a number above 0; it is in mm",
       [](Scene& s) { s.structures[0].margin_mm = 0; }},
      {"structures[1].color: \"red\" is not a color such as \"#0072b2\"",
       [](Scene& s) { s.structures[1].color = "red"; }},
      {"structures[2].name: \"liver\" is used twice", [](Scene& s) { s.structures.push_back(s.structures[0]); }},
      {"modes[2].name: \"s\" is used twice", [](Scene& s) { s.modes.push_back(s.modes[0]); }},
      {"modes: 33 are too many; at most 32 are allowed", [](Scene& s) { s.modes.resize(33, s.modes[1]); }},
      {"modes[1].strength_n: is missing; a strength is in newtons",
       [](Scene& s) { s.modes[1].strength_n = TransferFunction(); }},
      {"modes[1].strength_n: -1 is negative; a strength is in newtons, 0 or more",
       [](Scene& s) { s.modes[1].strength_n = TransferFunction(-1.0); }},
      {"modes[1].gates[0].factor.nodes[1][1]: -2 is negative; a gate is a factor, 0 or more",
       [](Scene& s) {
         s.modes[1].gates[0].factor = TransferFunction({{0, 1}, {1, -2}});
       }},
      {"modes[1].gates[0].structure: there is no structure \"\" in structures",
       [](Scene& s) { s.modes[1].gates[0].structure.clear(); }},
      {"modes[0].strength_n.structure: there is no structure \"spleen\" in structures",
       [](Scene& s) {
         s.modes[0].strength_of = Datum::distance;
         s.modes[0].strength_structure = "spleen";
       }},
      {"modes[1].structure: there is no structure \"\" in structures", [](Scene& s) { s.modes[1].structure.clear(); }},
      {"modes[0].structure: there is no structure \"spleen\" in structures",
       [](Scene& s) { s.modes[0].structure = "spleen"; }},
      {"modes[0].level_mm: is not finite", [](Scene& s) { s.modes[0].level_mm = infinity; }},
      {"modes[1].margin_mm: 0 is not a number above 0; it is in mm", [](Scene& s) { s.modes[1].margin_mm = 0; }},
      {"modes[0].from: there is no tissue \"\" in tissues", [](Scene& s) { s.modes[0].from.clear(); }},
      {"modes[0].to: there is no tissue \"bone\" in tissues", [](Scene& s) { s.modes[0].to = "bone"; }},
      {"modes[0].to: a boundary lies between two different tissues", [](Scene& s) { s.modes[0].to = "air"; }},
      {"modes[0].position_mm: is not finite", [](Scene& s) { s.modes[0].position_mm.z = nan; }},
      {"modes[0].direction: is not finite", [](Scene& s) { s.modes[0].direction.x = infinity; }},
      {"modes[0].direction: has no length", [](Scene& s) { s.modes[0].direction = Vec3(0); }},
      {"modes[0].color: \"0072b2\" is not a color such as \"#0072b2\"", [](Scene& s) { s.modes[0].color = "0072b2"; }},
  };
  for (const Spoilt& spoilt : all) {
    Scene scene = made_by_a_program();
    spoilt.spoil(scene);
    EXPECT_EQ(refused(scene), spoilt.refusal);
  }
  Scene scene = made_by_a_program();
  scene.modes[1].type = "pull";
  EXPECT_THAT(refused(scene), StartsWith("modes[1].type: there is no mode \"pull\"; there are: force, "));
}

TEST(SceneChecks, what_is_checked_may_be_at_its_limit) {
  for (const int most : {1, 1000}) {
    for (const int most_halts : {0, 1000}) {
      Scene scene = made_by_a_program();
      scene.subdivision.most = most;
      scene.subdivision.most_halts = most_halts;
      scene.modes.resize(32, scene.modes[1]);
      EXPECT_EQ(refused(scene), "accepted");
    }
  }
}

}  // namespace
}  // namespace palpate::modes
