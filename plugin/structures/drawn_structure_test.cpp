#include "plugin/structures/drawn_structure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

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

}  // namespace
}  // namespace palpate::plugin
