/// The reach of a structure's detailed distances: in steps of 3, 5, 8, 12 and 20 mm, each used as far as it is
/// sufficient.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "modes/scene/scene.h"
#include "plugin/structures/scene_structures.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

using SceneEdit = std::function<void(modes::Scene&, double)>;

TEST(StructureReach, IsTheLeastStepThatHoldsEachNumberOfTheScene) {
  const io::internal::TestFolder folder;
  testing::write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  const auto volume = std::make_shared<io::Volume>(*testing::registered_scan());
  volume->geometry.dimensions = {6, 6, 2};  // small: what is made is not looked at
  volume->geometry.slice_positions = {{-5, -5, 8}, {-5, -5, 10}};
  volume->voxels = std::vector<std::int16_t>(72);
  modes::Scene plain = testing::scene_of(folder / "rt.dcm");
  plain.modes[0].margin_mm = 0.5;
  plain.modes.push_back(plain.modes[0]);
  plain.modes[1].structure.clear();
  plain.structures.push_back({.name = "other", .file = plain.structures[0].file, .segment = "Cube"});
  const auto node = [](double at) { return modes::TransferFunction({{at, 1}, {at + 0.25, 0}}); };
  struct Number {
    const char* what;
    double beyond_mm;  // it, that the distances reach
    SceneEdit set;
  };
  const std::vector<Number> numbers{
      {"the structure's own margin", 1, [](modes::Scene& s, double mm) { s.structures[0].margin_mm = mm; }},
      {"a mode's margin", 1, [](modes::Scene& s, double mm) { s.modes[0].margin_mm = mm; }},
      {"a level inside", 2, [](modes::Scene& s, double mm) { s.modes[0].level_mm = mm; }},
      {"a level outside", 2, [](modes::Scene& s, double mm) { s.modes[0].level_mm = -mm; }},
      {"a gate", 1,
       [&](modes::Scene& s, double mm) {
         modes::Gate gate;
         gate.of = modes::Datum::distance;
         gate.structure = "cube";
         gate.factor = node(-mm);
         s.modes[1].gates = {gate};
       }},
      {"a strength", 1, [&](modes::Scene& s, double mm) {
         s.modes[1].strength_of = modes::Datum::distance;
         s.modes[1].strength_structure = "cube";
         s.modes[1].strength_n = modes::TransferFunction({{mm - 0.25, 1}, {mm, 0}});
       }}};
  const std::vector<SceneEdit> of_others{[](modes::Scene& s, double mm) { s.structures[1].margin_mm = mm; },
                                         [](modes::Scene& s, double mm) { s.modes[1].margin_mm = mm; },
                                         [](modes::Scene& s, double mm) { s.modes[1].level_mm = mm; },
                                         [&](modes::Scene& s, double mm) {
                                           modes::Gate gate;
                                           gate.of = modes::Datum::distance;
                                           gate.structure = "other";
                                           gate.factor = node(-mm);
                                           s.modes[1].gates = {gate};
                                         },
                                         [&](modes::Scene& s, double mm) {
                                           modes::Gate gate;
                                           gate.of = modes::Datum::value;
                                           gate.structure = "cube";
                                           gate.factor = node(-mm);
                                           s.modes[1].gates = {gate};
                                         }};
  std::vector<LoadedStructure> before;
  const auto reach = [&](const SceneEdit& set, double mm) {
    modes::Scene scene = plain;
    set(scene, mm);
    modes::Plan plan;
    plan.structures = {0};
    auto loaded = load_structures(scene, plan, *volume, before);
    const double reached = loaded.at(0).distance->reach_mm();
    before.push_back(loaded.at(0));  // each reach is made once
    return reached;
  };
  const double steps[] = {3, 5, 8, 12, 20};
  for (const Number& number : numbers) {
    for (std::size_t n = 0; n < 5; ++n) {
      const double most = steps[n] - number.beyond_mm;
      EXPECT_EQ(reach(number.set, most - 0.01), steps[n]) << number.what;
      EXPECT_EQ(reach(number.set, most), steps[n]) << number.what << ": just enough";
      EXPECT_EQ(reach(number.set, most + 0.01), n == 4 ? 20 : steps[n + 1]) << number.what;
    }
  }
  for (const SceneEdit& set : of_others) EXPECT_EQ(reach(set, 9), 3);
}

/// What was loaded before is used again where file, segment and reach are the same.
TEST(StructureReach, AnotherFileOrSegmentIsLoadedAnew) {
  const io::internal::TestFolder folder;
  for (const char* const file : {"a.dcm", "b.dcm"}) testing::write_contours(folder / file, "1.1", "7", "Doe^Jane");
  const auto volume = testing::registered_scan();
  modes::Plan plan;
  plan.structures = {0};
  const auto load = [&](const std::string& file, const std::optional<int>& number, const auto& before) {
    modes::Scene scene = testing::scene_of(folder / file);
    scene.structures[0].segment_number = number;
    return load_structures(scene, plan, *volume, before);
  };
  const auto first = load("a.dcm", {}, std::vector<LoadedStructure>());
  EXPECT_EQ(first.at(0).file, (folder / "a.dcm").string());
  EXPECT_EQ(first.at(0).segment, "Cube");
  EXPECT_EQ(load("a.dcm", {}, first).at(0).segment, "Cube");
  EXPECT_EQ(load("a.dcm", 1, first).at(0).segment, "#1");
  EXPECT_EQ(load("b.dcm", {}, first).at(0).file, (folder / "b.dcm").string());
  std::filesystem::remove(folder / "a.dcm");
  EXPECT_EQ(load("a.dcm", {}, first).at(0).distance, first[0].distance) << "nothing is read again";
  EXPECT_ANY_THROW(load("a.dcm", {}, std::vector<LoadedStructure>()));
  for (const auto& [name, number, asked] :
       {std::tuple{"Sphere", std::optional<int>(), "Sphere"}, {"Cube", std::optional<int>(7), "7"}}) {
    modes::Scene scene = testing::scene_of(folder / "b.dcm");
    scene.structures[0].segment = name;
    scene.structures[0].segment_number = number;
    try {
      load_structures(scene, plan, *volume, {});
      FAIL() << "loaded";
    } catch (const std::exception& error) {
      EXPECT_EQ(error.what(), std::string("structure \"cube\": b.dcm has no \"") + asked + "\"; there are: 1 Cube");
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
