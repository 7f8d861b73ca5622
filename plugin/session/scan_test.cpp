/// What a scan is made into before it is felt: its values, its box, its words, and the scene that suits it.

#include "plugin/session/scan.h"

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

#include "io/fields/filtered.h"
#include "modes/scene/scene_json.h"
#include "plugin/session/registered_structure.h"
#include "plugin/session/scan_values.h"
#include "plugin/session/scene_fit.h"
#include "plugin/session/study_structures.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

io::Volume stored(io::Volume::Voxels voxels, double slope, double intercept, const glm::ivec3& size) {
  io::Volume volume;
  volume.geometry.dimensions = size;
  for (int k = 0; k < size.z; ++k) volume.geometry.slice_positions.emplace_back(0, 0, k);
  volume.voxels = std::move(voxels);
  volume.slope = slope;
  volume.intercept = intercept;
  return volume;
}

/// Whole numbers stay whole where 16 bits hold them, and every value is the one that it was.
TEST(ScanValues, AreTheStoredOnesRescaled) {
  struct Case {
    double slope, intercept;
    std::int16_t low, high;
    bool is_whole;
  };
  for (const Case& c :
       {Case{2, -1024, -5, 3000, true}, Case{-2, 100, -5, 3000, true}, Case{1, 0.5, -5, 3000, false},
        Case{0.5, 0, -5, 3000, false}, Case{1, 32767 - 3000, -5, 3000, true}, Case{1, 32768 - 3000, -5, 3000, false},
        Case{1, -32768 + 5, -5, 3000, true}, Case{1, -32769 + 5, -5, 3000, false},
        Case{-1, -32768 + 3000, -5, 3000, true}, Case{-1, -32769 + 3000, -5, 3000, false}}) {
    std::vector<std::int16_t> voxels{c.low, 7, c.high, 11, -1, 40, 99, 1000};
    io::Volume before = stored(voxels, c.slope, c.intercept, {2, 2, 2});
    before.padding = {-4, 30};
    const io::Volume after = scan_values(before);
    EXPECT_EQ(after.slope, 1);
    EXPECT_EQ(after.intercept, 0);
    EXPECT_EQ(std::holds_alternative<std::vector<std::int16_t>>(after.voxels), c.is_whole) << c.slope << c.intercept;
    for (int n = 0; n < 8; ++n) {
      const double wanted = c.slope * voxels[static_cast<std::size_t>(n)] + c.intercept;
      EXPECT_EQ(after.value_at(n % 2, n / 2 % 2, n / 4), wanted) << c.slope << " " << c.intercept;
      EXPECT_EQ(before.value_at(n % 2, n / 2 % 2, n / 4), wanted);
    }
    ASSERT_TRUE(after.padding);
    const double first = c.slope * -4 + c.intercept, last = c.slope * 30 + c.intercept;
    EXPECT_EQ(after.padding->first, std::min(first, last));
    EXPECT_EQ(after.padding->second, std::max(first, last));
  }
}

TEST(Scan, ItsBoxHoldsTheCentersOfItsCornerVoxels) {
  testdata::Grid grid;
  grid.size = {17, 9, 13};
  grid.spacing = {0.7, 1.3, 2.1};
  grid.center = {10, -20, 30};
  grid.tilt_degrees = 12;
  const io::Geometry geometry =
      testdata::make_geometry(testdata::rotated(grid, glm::normalize(glm::dvec3(2, 1, -1)), 40));
  glm::dvec3 low(1e9), high(-1e9);
  for (int k = 0; k < 13; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 17; ++i) {
        const glm::dvec3 at = geometry.to_patient(glm::dvec3(i, j, k));
        low = glm::min(low, at);
        high = glm::max(high, at);
      }
    }
  }
  EXPECT_LT(glm::distance(bounding_box(geometry).low, low), 1e-9);
  EXPECT_LT(glm::distance(bounding_box(geometry).high, high), 1e-9);
}

TEST(Scan, IsDescribedByItsVoxelsAndItsFilter) {
  io::Volume volume = testdata::scan(testdata::make_sphere(5),
                                     testdata::make_geometry({.size = {12, 10, 8}, .spacing = {0.75, 0.957, 2.5}}));
  EXPECT_EQ(describe_scan(volume), "CT, 12 x 10 x 8 voxels of 0.75 x 0.957 x 2.5 mm");
  const auto filtered =
      io::filtered(std::make_shared<const io::Volume>(volume), {.type = io::find_filter_type("median")});
  EXPECT_EQ(describe_scan(*filtered),
            "CT, 12 x 10 x 8 voxels of 0.75 x 0.957 x 2.5 mm, " + io::in_words(io::filter_of(*filtered)));
}

TEST(Scan, WithoutASceneIsFeltAsItsModalitySuits) {
  io::Volume volume = testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(8)}));
  const auto felt_as = [&] { return modes::to_json(scene_for("", volume)); };
  const auto named = [](const char* name) { return modes::to_json(modes::load_scene(name)); };
  EXPECT_EQ(felt_as(), named("ct-skin-and-bone"));
  EXPECT_EQ(modes::to_json(scene_for("ct-bone", volume)), named("ct-bone"));
  volume.modality = "MR";
  EXPECT_EQ(felt_as(), named("mr-brain"));
  volume.vectors = std::make_shared<const io::VectorComponents>();
  EXPECT_EQ(felt_as(), named("flow"));
}

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

/// No voxel at all is no value that does not fit, and zeros of either kind stay.
TEST(ScanValues, OfNoVoxelsAreNone) {
  const io::Volume none = scan_values(stored(std::vector<std::uint16_t>(), 2, 1, {0, 0, 0}));
  EXPECT_EQ(none.slope, 1);
  EXPECT_EQ(none.intercept, 0);
  EXPECT_FALSE(none.padding);
}

/// The same of words without a sign, and of floats, which stay floats.
TEST(ScanValues, OfEveryKindOfVoxelAreTheStoredOnesRescaled) {
  std::mt19937 random(4);
  for (const auto& [slope, intercept] : {std::pair{1.0, -1024.0}, {3.0, 0.0}, {-2.0, 7.0}, {0.25, -0.5}, {1.0, 0.0}}) {
    std::vector<std::uint16_t> words(60);
    std::vector<float> floats(60);
    for (std::size_t n = 0; n < words.size(); ++n) {
      words[n] = static_cast<std::uint16_t>(random() % 10000);
      floats[n] = static_cast<float>(words[n]) / 8;
    }
    const io::Volume of_words = scan_values(stored(words, slope, intercept, {5, 4, 3}));
    const io::Volume of_floats = scan_values(stored(floats, slope, intercept, {5, 4, 3}));
    for (std::size_t n = 0; n < words.size(); ++n) {
      const int i = static_cast<int>(n) % 5, j = static_cast<int>(n) / 5 % 4, k = static_cast<int>(n) / 20;
      ASSERT_EQ(of_words.value_at(i, j, k), slope * words[n] + intercept);
      ASSERT_EQ(of_floats.value_at(i, j, k), slope * static_cast<double>(floats[n]) + intercept);
    }
    EXPECT_TRUE(std::holds_alternative<std::vector<float>>(of_floats.voxels));
    const bool is_whole = slope == std::floor(slope) && intercept == std::floor(intercept);
    EXPECT_EQ(std::holds_alternative<std::vector<float>>(of_words.voxels), !is_whole);
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
