#include "plugin/report/structure_crossings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <memory>

#include "io/fields/filtered.h"
#include "io/structures/distance_field.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using ::testing::HasSubstr;

/// A ball of 12 mm in fat, whose labels go as far as 12.8 mm. Beside it in the scene is a structure that nothing reads.
struct Study {
  modes::Scene scene;
  PreparedScene felt;
};

Study study_of_a_ball(double value_of_ball) {
  const io::Geometry geometry = testdata::make_geometry({.size = glm::ivec3(40)});
  Study study;
  study.felt.volume = std::make_shared<const io::Volume>(testdata::scan(
      {.background = -100, .bodies = {{testdata::Ball{{0, 0, 0}, 12}, value_of_ball}}}, geometry, {.noise = 10}));
  io::Mask mask;
  mask.geometry = geometry;
  mask.size = geometry.dimensions;
  for (int n = 0; n < 40 * 40 * 40; ++n) {
    const glm::dvec3 at = geometry.to_patient(glm::dvec3(n % 40, n / 40 % 40, n / 1600));
    mask.occupancy.push_back(glm::length(at) < 12.8 ? io::Mask::full : 0);
  }
  study.scene.structures = {{.name = "unread", .file = "seg.dcm"}, {.name = "liver", .file = "seg.dcm"}};
  auto plan = std::make_shared<modes::Plan>();
  plan->structures = {1};
  study.felt.plan = plan;
  study.felt.structures.resize(1);
  study.felt.structures[0].distance = io::distance_of(mask);
  return study;
}

TEST(StructureCrossings, TellHowFarTheScansOwnEdgeIs) {
  const Study study = study_of_a_ball(60);
  const auto crossings = crossings_along({-18, 0, 0}, {18, 0, 0}, study.felt);
  ASSERT_EQ(crossings.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    const StructureCrossing& crossing = crossings[n];
    const double sign = n == 0 ? -1 : 1;
    EXPECT_EQ(crossing.structure, 1U);
    EXPECT_EQ(crossing.entering, n == 0);
    EXPECT_NEAR(crossing.place_mm.x, 12.8 * sign, 0.4);
    EXPECT_NEAR(crossing.depth_mm, crossing.place_mm.x + 18, 1e-6);
    EXPECT_NEAR(study.felt.structures[0].distance->sample(crossing.place_mm).mm, 0, 1e-6);
    ASSERT_TRUE(crossing.own_edge);
    EXPECT_NEAR(crossing.place_mm.x + crossing.own_edge->mm, 12 * sign, 0.15);
    EXPECT_NEAR(crossing.own_edge->rise, -160 * sign, 30);
  }
  EXPECT_THAT(in_words(crossings[0], study.scene), HasSubstr("liver entered at depth "));
  EXPECT_THAT(in_words(crossings[0], study.scene), HasSubstr(" mm farther on, known to +-0."));
  EXPECT_THAT(in_words(crossings[1], study.scene), HasSubstr("liver left at depth "));
  EXPECT_THAT(in_words(crossings[1], study.scene), HasSubstr(" mm before, known to +-0."));
}

TEST(StructureCrossings, SayWhereTheScanShowsNone) {
  const Study study = study_of_a_ball(-100);
  const auto crossings = crossings_along({0, 0, 0}, {0, 17, 0}, study.felt);
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_FALSE(crossings[0].entering);
  EXPECT_FALSE(crossings[0].own_edge);
  EXPECT_THAT(in_words(crossings[0], study.scene), HasSubstr("; the scan's own values show no edge within 5 mm"));
}

// A filter hides noise, and how well an edge is known with it.
TEST(StructureCrossings, TellTheScansOwnEdgeAndNotTheFilters) {
  Study study = study_of_a_ball(60);
  const auto raw = crossings_along({-18, 0, 0}, {18, 0, 0}, study.felt);
  study.felt.volume = io::filtered(study.felt.volume, {.type = io::find_filter_type("median")});
  const auto filtered = crossings_along({-18, 0, 0}, {18, 0, 0}, study.felt);
  ASSERT_EQ(filtered.size(), raw.size());
  for (std::size_t n = 0; n < raw.size(); ++n) {
    EXPECT_EQ(filtered[n].own_edge->mm, raw[n].own_edge->mm);
    EXPECT_EQ(filtered[n].own_edge->known_to_mm, raw[n].own_edge->known_to_mm);
  }
}

/// A stroke that begins on the surface: what comes next is entered where the stroke goes in.
TEST(StructureCrossings, FromTheSurfaceItGoesIn) {
  Study study = study_of_a_ball(60);
  io::Mask half;  // all that lies farther back than 0: its surface is between two voxels
  half.geometry = testdata::make_geometry({.size = glm::ivec3(40)});
  half.size = half.geometry.dimensions;
  for (int n = 0; n < 40 * 40 * 40; ++n) half.occupancy.push_back(n / 40 % 40 >= 20 ? io::Mask::full : 0);
  study.felt.structures[0].distance = io::distance_of(half);
  ASSERT_EQ(study.felt.structures[0].distance->sample({0.5, 0, 0.5}).mm, 0);
  const auto crossings = crossings_along({0.5, 0, 0.5}, {0.5, 10, 0.5}, study.felt);
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_TRUE(crossings[0].entering);
  EXPECT_NEAR(crossings[0].depth_mm, 0, 1e-6);
}

TEST(StructureCrossings, AreNoneWhereTheStrokeStaysOutside) {
  const Study study = study_of_a_ball(60);
  EXPECT_TRUE(crossings_along({-18, 15, 0}, {18, 15, 0}, study.felt).empty());
}

}  // namespace
}  // namespace palpate::plugin
