// What each starting scene for a part of the body is for, on slabs of its tissues: the boundary is felt from outside,
// the wall of a vessel from inside, with the strength that the scene gives it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/tissue_colors.h"
#include "modes/testing/test_rig.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

struct StartingCase {
  std::string scene, mode;
  double outer, inner;  ///< HU
  double strength_n;    ///< 0: not felt
};

/// The largest force of one mode of the scene alone on a slow way through a slab's boundary at the origin.
double yields_n(const StartingCase& boundary) {
  Scene scene = load_scene(boundary.scene);
  bool has_mode = false;
  for (Mode& mode : scene.modes) {
    mode.enabled = mode.name == boundary.mode;
    has_mode = has_mode || mode.enabled;
  }
  EXPECT_TRUE(has_mode) << boundary.scene << " has no " << boundary.mode;
  const Vec3 inward(0, 0, -1);
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_slab(inward, std::array{testdata::Layer{0, boundary.inner}}, boundary.outer),
                     testdata::make_geometry({.size = {24, 24, 40}}), {.noise = 5}));
  const io::VolumeFields source(volume, io::FieldSet::value | io::FieldSet::gradient,
                                io::default_gradient_scale_mm(volume->geometry));
  testing::Hand hand(scene, source);
  double most = 0;
  for (double depth = -8; depth < 10; depth += 0.02) {
    hand.move_to(depth * inward);
    most = std::max(most, glm::length(hand.force()));
  }
  return most;
}

/// So a tissue keeps its color when the proposed scene follows the starting one.
TEST(StartingScenes, have_the_colors_of_their_tissues) {
  for (const std::string& name : starting_scenes()) {
    for (const Mode& mode : load_scene(name).modes) {
      if (mode.type != "surface" || name == "ct-vessels") continue;
      EXPECT_EQ(mode.color, color_of(kind_of(mode.name))) << name << ": " << mode.name;
    }
  }
}

TEST(StartingScenes, let_the_boundaries_of_their_part_of_the_body_be_felt) {
  const std::vector<StartingCase> cases{{"ct-chest", "skin and lung surface", -1000, -100, 1.0},
                                        {"ct-chest", "skin and lung surface", -850, 40, 1.0},
                                        {"ct-chest", "bone", 40, 350, 2.5},
                                        {"ct-abdomen", "skin", -1000, -100, 1.0},
                                        {"ct-abdomen", "organs in fat", -100, 50, 0.7},
                                        {"ct-abdomen", "organs in fat", -1000, -100, 0},
                                        {"ct-abdomen", "skin", -100, 50, 0},
                                        {"ct-abdomen", "bone", 40, 500, 2.5},
                                        {"ct-spine", "bone", 40, 350, 2.5},
                                        {"ct-spine", "skin", -1000, -100, 0.5},
                                        {"ct-spine", "bone", 40, 120, 0},
                                        {"ct-vessels", "wall", 300, 40, 1.0},
                                        {"ct-vessels", "wall", 40, 300, 0}};
  for (const StartingCase& boundary : cases) {
    SCOPED_TRACE(boundary.scene + ", " + boundary.mode + ": " + std::to_string(boundary.outer) + " to " +
                 std::to_string(boundary.inner) + " HU");
    EXPECT_NEAR(yields_n(boundary), boundary.strength_n, 0.1 * boundary.strength_n + 0.02);
  }
}

}  // namespace
}  // namespace palpate::modes
