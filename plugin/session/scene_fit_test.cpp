/// Whether a scene can be felt on a scan; what the panel adds to a scene for a structure; motions in words.

#include "plugin/session/scene_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/structures/registered_structure.h"
#include "plugin/structures/study_structures.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// What keeps a whole scene from being felt is named, and it is nothing as soon as one of its modes can be.
TEST(SceneFit, NamesTheFieldsThatEveryModeLacks) {
  const io::Volume volume = testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(8)}));
  const auto why_not = [&](const std::string& modes, const std::string& name = "") {
    return static_cast<std::string>(why_not_felt(
        modes::scene_from_json("{\"version\": 1, \"name\": \"" + name + "\", \"modes\": [" + modes + "]}", "test"),
        volume));
  };
  const std::string surface = R"({"type": "surface", "strength_n": 1})";
  const std::string follow = R"({"type": "follow", "strength_n": 0.3})";
  const std::string gated = R"({"type": "surface", "strength_n": 1, "gates": [{"of": "vector", "nodes": [[0, 1]]}]})";
  EXPECT_EQ(why_not(surface), "");
  EXPECT_EQ(why_not(surface + "," + follow), "");
  EXPECT_EQ(why_not(""), "");
  EXPECT_NE(why_not(follow).find("vector field"), std::string::npos) << why_not(follow);
  EXPECT_NE(why_not(follow).find("this scene"), std::string::npos) << why_not(follow);
  EXPECT_NE(why_not(follow, "stream").find("the scene \"stream\""), std::string::npos);
  EXPECT_NE(why_not(gated), "") << "a gate reads, too";
  for (const std::string type : {"surface", "friction", "force"}) {
    const std::string strength =
        R"({"type": ")" + type + R"(", "strength_n": {"of": "vector", "nodes": [[0, 0], [9, 1]]}})";
    EXPECT_NE(why_not(strength).find("vector field"), std::string::npos) << type << "'s strength reads, too";
  }
  std::string off = surface;
  off.insert(1, "\"enabled\": false, ");
  EXPECT_NE(why_not(follow + "," + off), "") << "what is switched off is not felt";
}

TEST(RegisteredStructure, ItsMotionIsToldInMillimetersAndDegrees) {
  io::RigidMotion motion;
  motion.shift = {1.04, -2.26, 300};
  EXPECT_EQ(in_words(motion), "1.0, -2.3, 300.0 mm");
  for (const double degrees : {0.02, 12.5, 90.0, 179.5}) {
    // About an axis that is none of the patient's: Rodrigues' formula, column by column.
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, -2, 0.5));
    const double turned = degrees * M_PI / 180;
    for (int column = 0; column < 3; ++column) {
      glm::dvec3 unit(0);
      unit[column] = 1;
      motion.turn[column] = std::cos(turned) * unit + std::sin(turned) * glm::cross(axis, unit) +
                            (1 - std::cos(turned)) * glm::dot(axis, unit) * axis;
    }
    std::array<char, 80> words{};
    std::snprintf(words.data(), words.size(), "1.0, -2.3, 300.0 mm, turned by %.2f degrees", degrees);
    EXPECT_EQ(in_words(motion), words.data());
  }
}

/// A turn is told from a hundredth of a degree on, as it is rounded; also a half turn, whose cosine rounding takes
/// below -1.
TEST(RegisteredStructure, ItsTurnIsToldFromAHundredthOfADegreeOn) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    io::RigidMotion motion;
    for (int column = 0; column < 3; ++column) {  // a half turn: 2 a a^T - 1
      for (int row = 0; row < 3; ++row)
        motion.turn[column][row] = 2 * axis[column] * axis[row] - (row == column ? 1 : 0);
    }
    ASSERT_EQ(in_words(motion), "0.0, 0.0, 0.0 mm, turned by 180.00 degrees");
  }
  for (const auto& [degrees, words] : {std::pair{0.0, ""},
                                       {0.0048, ""},
                                       {0.0052, ", turned by 0.01 degrees"},
                                       {0.0098, ", turned by 0.01 degrees"},
                                       {0.0152, ", turned by 0.02 degrees"}}) {
    const double cosine = std::cos(degrees * M_PI / 180), sine = std::sin(degrees * M_PI / 180);
    io::RigidMotion motion;
    motion.turn = glm::dmat3({cosine, 0, -sine}, {0, 1, 0}, {sine, 0, cosine});
    EXPECT_EQ(in_words(motion), std::string("0.0, 0.0, 0.0 mm") + words) << degrees;
  }
}

io::Structure outlined(const std::string& name, int number) {
  io::Structure structure;
  structure.file = "/study/seg.dcm";
  structure.name = name;
  structure.number = number;
  structure.color = "#102030";
  return structure;
}

/// What the panel's buttons add for a structure: a boundary of 1 N, a wall of 2 N around its margin, a gate that opens
/// over the first millimeter inside.
TEST(StudyStructures, AreAddedToASceneAsTheyAreAskedFor) {
  modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "friction", "name": "aorta", "strength_n": 0.1}]})", "test");
  add_boundary_of(scene, outlined("aorta", 4));
  add_keep_out_of(scene, outlined("aorta", 4), 3.5);
  add_gate_of(scene, 0, outlined("", 5));
  add_boundary_of(scene, outlined("aorta", 6));
  ASSERT_EQ(scene.structures.size(), 3U);
  EXPECT_EQ(scene.structures[0].name, "aorta");
  EXPECT_EQ(scene.structures[0].file, "/study/seg.dcm");
  EXPECT_EQ(scene.structures[0].segment_number, 4);
  EXPECT_EQ(scene.structures[0].color, "#102030");
  EXPECT_EQ(scene.structures[0].margin_mm, 3.5);
  EXPECT_EQ(scene.structures[1].name, "structure");
  EXPECT_EQ(scene.structures[1].margin_mm, std::nullopt);
  EXPECT_EQ(scene.structures[2].name, "aorta 2") << "another one of that name";
  ASSERT_EQ(scene.modes.size(), 4U);
  const modes::Mode &boundary = scene.modes[1], &keep_out = scene.modes[2], &second = scene.modes[3];
  EXPECT_EQ(boundary.type, "surface");
  EXPECT_EQ(boundary.name, "aorta 2") << "a mode is called so already";
  EXPECT_EQ(boundary.structure, "aorta");
  EXPECT_EQ(boundary.color, "#102030");
  EXPECT_EQ(boundary.strength_n(-7), 1);
  EXPECT_EQ(keep_out.type, "keep_out");
  EXPECT_EQ(keep_out.name, "Keep out of aorta");
  EXPECT_EQ(keep_out.structure, "aorta");
  EXPECT_EQ(keep_out.margin_mm, 3.5);
  EXPECT_EQ(keep_out.strength_n(-7), 2);
  EXPECT_EQ(second.structure, "aorta 2");
  ASSERT_EQ(scene.modes[0].gates.size(), 1U);
  const modes::Gate& gate = scene.modes[0].gates[0];
  EXPECT_EQ(gate.of, modes::Datum::distance);
  EXPECT_EQ(gate.structure, "structure");
  for (const double mm : {-3.0, 0.0, 0.25, 1.0, 9.0}) EXPECT_NEAR(gate.factor(mm), std::clamp(mm, 0.0, 1.0), 1e-12);
  modes::validate(scene);
}

}  // namespace
}  // namespace palpate::plugin
