#include "plugin/structures/drawn_structure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/structures/scene_structures.h"
#include "plugin/structures/shared_distance.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

/// Circles on planes 2 mm apart, which stand for 2 mm each.
io::ContoursEdit cylinder(const io::Vec3& middle, double radius_mm, int planes) {
  constexpr double apart_mm = 2;
  constexpr int corners = 72;
  io::ContoursEdit contours;
  for (int plane = 0; plane < planes; ++plane) {
    auto& loop = contours.loops_mm.emplace_back();
    for (int n = 0; n < corners; ++n) {
      const double angle = 2 * std::numbers::pi * n / corners;
      loop.push_back(middle + io::Vec3(radius_mm * std::cos(angle), radius_mm * std::sin(angle),
                                       apart_mm * (plane - 0.5 * (planes - 1))));
    }
  }
  return contours;
}

modes::SceneStructure named(const char* name, const io::ContoursEdit& contours) {
  modes::SceneStructure structure;
  structure.name = name;
  structure.edits = {contours};
  return structure;
}

io::Geometry lattice() {
  io::Geometry scan;
  scan.dimensions = {64, 64, 64};
  scan.spacing_i = scan.spacing_j = 1;
  for (int k = 0; k < 64; ++k) scan.slice_positions.emplace_back(-32, -32, k - 32);
  return scan;
}

TEST(DrawnStructure, ItIsMeasuredByWhatItsContoursHold) {
  for (const double radius : {8.0, 14.5}) {
    for (const int planes : {7, 15}) {
      const io::Vec3 middle(3, -2, 1.5);
      const io::Structure structure = drawn_structure(named("drawn", cylinder(middle, radius, planes)));
      const io::StructureMeasures measures = io::measure(structure);
      const double volume = std::numbers::pi * radius * radius * 2 * planes;
      // What is felt: beyond the last planes the outline closes as it does where a file's contours end.
      constexpr double most_beyond_mm = 1.5;
      EXPECT_GT(measures.volume_mm3 / volume, 0.99) << radius << " " << planes;
      EXPECT_LT(measures.volume_mm3 / volume, 1 + most_beyond_mm / (2 * planes)) << radius << " " << planes;
      EXPECT_LT(glm::distance(measures.centroid_mm, middle), 0.1);
      EXPECT_NEAR(measures.box_low_mm.x, middle.x - radius, 1e-9);
      EXPECT_NEAR(measures.box_high_mm.z, middle.z + planes - 1, 1e-9);
      EXPECT_EQ(measures.contours, static_cast<std::uint64_t>(planes));
    }
  }
}

TEST(DrawnStructure, ItsDistanceIsTheOneThatIsFelt) {
  const io::ContoursEdit contours = cylinder({0, 0, 0}, 12, 9), others = cylinder({0, 0, 0}, 6, 9);
  const io::Structure one = drawn_structure(named("one", contours)), other = drawn_structure(named("other", others));
  const io::Geometry scan = lattice();
  const auto felt = shared_distance(contours, scan, 5);
  EXPECT_EQ(shared_distance(one, scan, 5), felt);
  const auto beside = shared_distance(other, scan, 5);
  EXPECT_NE(beside, felt) << "neither has a file nor a number";
  EXPECT_NEAR(felt->sample({9, 0, 0}).mm, 3, 0.1);
  EXPECT_NEAR(beside->sample({9, 0, 0}).mm, -3, 0.1);
}

TEST(DrawnStructure, ItIsKnownByItsName) {
  const modes::SceneStructure drawn = named("drawn", cylinder({0, 0, 0}, 12, 9));
  const io::Structure structure = drawn_structure(drawn);
  EXPECT_TRUE(is_same(drawn, structure));
  EXPECT_FALSE(is_same(named("other", std::get<io::ContoursEdit>(drawn.edits.front())), structure));
  EXPECT_TRUE(is_same(structure, drawn_structure(drawn)));
  modes::Scene scene;
  scene.structures = {drawn};
  EXPECT_EQ(name_in_scene(scene, structure), "drawn");
  EXPECT_EQ(scene.structures.size(), 1U);
  EXPECT_EQ(making_edits(structure), 1U);
  io::Structure of_file;
  of_file.file = "/study/liver.dcm";
  of_file.name = "drawn";
  EXPECT_FALSE(is_same(drawn, of_file));
  EXPECT_FALSE(is_same(structure, of_file));
  EXPECT_EQ(contours_of(of_file), nullptr);
  EXPECT_EQ(making_edits(of_file), 0U);
}

/// Distances are told as far as they were asked for, also where the same contours are held with another reach.
TEST(DrawnStructure, EachReachHasItsOwnField) {
  const io::ContoursEdit contours = cylinder({0, 0, 0}, 12, 15);
  const io::Geometry scan = lattice();
  std::vector<std::shared_ptr<const io::DistanceField>> held;
  for (const double reach_mm : {5.0, 3.0, 12.0, 8.0}) {
    held.push_back(shared_distance(contours, scan, reach_mm));
    EXPECT_EQ(held.back()->reach_mm(), reach_mm);
    EXPECT_NEAR(held.back()->sample({12 + reach_mm - 1, 0, 0}).mm, 1 - reach_mm, 0.2) << reach_mm;
    EXPECT_EQ(shared_distance(contours, scan, reach_mm), held.back());
  }
}

/// What is loaded of a scene with one structure, which is drawn.
LoadedStructure loaded(const modes::SceneStructure& structure) {
  modes::Scene scene;
  scene.structures = {structure};
  modes::Plan plan;
  plan.structures = {0};
  io::Volume scan;
  scan.geometry = lattice();
  return load_structures(scene, plan, scan, {}).at(0);
}

TEST(DrawnStructure, OffTheScanIsSaidToBe) {
  for (const io::Vec3& middle : {io::Vec3(0), io::Vec3(40, 0, 0), io::Vec3(70, 0, 0), io::Vec3(0, -70, 0),
                                 io::Vec3(0, 0, 70), io::Vec3(300, 300, 300)}) {
    const LoadedStructure drawn = loaded(named("drawn", cylinder(middle, 12, 9)));
    std::string said;
    for (const Text& warning : drawn.warnings) said += warning;
    // The scan ends at 32 mm, and the structure is 12 mm wide to each side.
    EXPECT_EQ(said, glm::length(middle) < 60 ? ""
                                             : "scene: \"drawn\" lies wholly outside the scan: choose one that was "
                                               "outlined on this scan")
        << middle.x;
  }
}

/// The edit that cannot be done is named by its place in the list, whatever stands before it and after it.
TEST(DrawnStructure, TheEditThatCannotBeDoneIsNamedByItsNumber) {
  constexpr std::size_t edits = 5;
  for (std::size_t wrong = 2; wrong <= edits; ++wrong) {
    modes::SceneStructure structure = named("drawn", cylinder({0, 0, 0}, 12, 9));
    for (std::size_t n = 2; n <= edits; ++n) {
      if (n == wrong) {
        structure.edits.emplace_back(io::TraceEdit{.points_mm = {{28, 0, 0}}, .known_to_mm = {}, .reach_mm = 4});
      } else {
        structure.edits.emplace_back(
            io::AddEdit{.tube = {.path_mm = {{0, 12, static_cast<double>(n)}}, .radius_mm = 3}});
      }
    }
    try {
      loaded(structure);
      ADD_FAILURE() << wrong;
    } catch (const std::invalid_argument& error) {
      const std::string said = error.what();
      EXPECT_TRUE(said.starts_with("structure \"drawn\": edit " + std::to_string(wrong) + ": trace: ")) << said;
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
