// One boundary for what has one name: on phantoms whose boundaries a clinician would count, and on levels that one
// value cannot be between.
#include "modes/scene/merge_boundaries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/testing/test_rig.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::HalfSpace;

Suggestion of_tissues(const std::vector<std::pair<std::string, double>>& tissues) {
  Suggestion suggestion;
  for (const auto& [name, hu] : tissues) {
    suggestion.scene.tissues.push_back({name, hu - 50, hu + 50, 10});
    suggestion.typical.push_back(hu);
  }
  return suggestion;
}

TEST(MergeBoundaries, skin_over_fat_and_over_muscle_is_one_at_a_level_between_both) {
  Suggestion suggestion = of_tissues({{"air", -950}, {"fat", -100}, {"soft tissue", 60}});
  std::vector<FoundBoundary> boundaries{{.low = 0, .high = 2, .middle = -445, .share = 0.3},
                                        {.low = 1, .high = 2, .middle = -20, .share = 0.25},
                                        {.low = 0, .high = 1, .middle = -525, .share = 0.1}};
  internal::merge_boundaries(boundaries, suggestion);
  ASSERT_EQ(boundaries.size(), 2U);
  EXPECT_NEAR(boundaries[0].share, 0.4, 1e-12);
  EXPECT_NEAR(boundaries[0].middle, -465, 1e-9);  // (0.3 * -445 + 0.1 * -525) / 0.4
  EXPECT_EQ(boundaries[0].low, 0U);
  ASSERT_EQ(suggestion.scene.tissues.size(), 4U);
  const Tissue& over = suggestion.scene.tissues[boundaries[0].high];
  EXPECT_EQ(over.name, "fat to soft tissue");
  EXPECT_EQ(over.low, -150);
  EXPECT_EQ(over.high, 110);
  EXPECT_EQ(suggestion.typical.back(), -100) << "the fainter of both";
  EXPECT_EQ(boundaries[1].middle, -20) << "fat and soft tissue are not skin";
}

TEST(MergeBoundaries, bone_at_air_is_one_unless_no_level_is_between) {
  for (const double dense : {700.0, 2400.0}) {
    Suggestion suggestion = of_tissues({{"air", -950}, {"bone (160 HU)", 160}, {"bone", dense}});
    std::vector<FoundBoundary> boundaries{{.low = 0, .high = 2, .middle = 0.5 * (dense - 950), .share = 0.3},
                                          {.low = 0, .high = 1, .middle = -395, .share = 0.1}};
    internal::merge_boundaries(boundaries, suggestion);
    // A quarter of the way to dense bone at 2400 HU is -112 HU, 0.75 of that to 160 HU.
    EXPECT_EQ(boundaries.size(), dense < 1000 ? 1U : 2U);
  }
}

/// However often each of its parts occurs: nearer to either tissue than that, the tissue's own spread would be felt.
TEST(MergeBoundaries, a_merged_boundary_lies_well_between_the_tissues_of_each_of_its_parts) {
  std::mt19937 random(1);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int merged = 0, near_an_end = 0;
  for (int n = 0; n < 1000; ++n) {
    const bool to_bone = n % 2 == 0;
    const double fainter = to_bone ? between(160, 400) : between(-150, -30);
    const double denser = to_bone ? between(fainter + 100, 2000) : between(0, 140);
    Suggestion suggestion = of_tissues({{"air", -950}, {"the fainter", fainter}, {"the denser", denser}});
    std::vector<FoundBoundary> boundaries{
        {.low = 0, .high = 1, .middle = 0.5 * (fainter - 950), .share = between(0.01, 0.5)},
        {.low = 0, .high = 2, .middle = 0.5 * (denser - 950), .share = between(0.01, 0.5)}};
    internal::merge_boundaries(boundaries, suggestion);
    if (boundaries.size() > 1) continue;
    ++merged;
    for (const double high : {fainter, denser}) {
      const double part = (boundaries[0].middle + 950) / (high + 950);
      EXPECT_GE(part, 0.25 - 1e-12) << fainter << ", " << denser;
      EXPECT_LE(part, 0.7 + 1e-12) << fainter << ", " << denser;
      near_an_end += part > 0.69 ? 1 : 0;
    }
  }
  EXPECT_GT(merged, 500);
  EXPECT_GT(near_an_end, 10);
}

TEST(MergeBoundaries, two_kinds_of_bone_in_tissue_stay_two) {
  Suggestion suggestion = of_tissues({{"soft tissue", 40}, {"bone (200 HU)", 200}, {"bone (400 HU)", 400}});
  std::vector<FoundBoundary> boundaries{{.low = 0, .high = 2, .middle = 148, .share = 0.3},
                                        {.low = 0, .high = 1, .middle = 90, .share = 0.1},
                                        {.low = 1, .high = 2, .middle = 300, .share = 0.1}};
  internal::merge_boundaries(boundaries, suggestion);
  EXPECT_EQ(boundaries.size(), 3U);
  EXPECT_EQ(suggestion.scene.tissues.size(), 3U);
}

/// Skin of fat on one side and of muscle on the other, and bone between them: two boundaries, each felt where it is
/// from either side.
TEST(MergeBoundaries, of_a_limb_with_fat_on_one_side_and_muscle_on_the_other_are_skin_and_bone_felt_where_they_are) {
  // Top and bottom are alike but for their tissues: bone from -10 to 10 mm, skin at -24 and 24 mm.
  const testdata::Phantom limb{.background = testdata::air_hu,
                               .bodies = {{HalfSpace{{0, 0, 1}, 24}, -100},
                                          {HalfSpace{{0, 0, 1}, 10}, 600},
                                          {HalfSpace{{0, 0, 1}, -10}, 50},
                                          {HalfSpace{{0, 0, 1}, -24}, testdata::air_hu}}};
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(limb, testdata::make_geometry({.size = {40, 40, 64}}), {.noise = 10}));
  const Suggestion found = suggest(volume);
  std::vector<std::string> names;
  for (const FoundBoundary& boundary : found.boundaries) names.push_back(found.scene.modes[boundary.mode].name);
  const io::VolumeFields source(volume, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high,
                                io::default_gradient_scale_mm(volume->geometry));
  for (const auto& [name, depth] : {std::pair{"Skin", 24.0}, std::pair{"Bone", 10.0}}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(std::ranges::count_if(names, [prefix = name](const std::string& one) { return one.starts_with(prefix); }),
              1)
        << ::testing::PrintToString(names);
    Scene scene = found.scene;
    for (Mode& mode : scene.modes) mode.enabled = mode.name == name;
    for (const double side : {1.0, -1.0}) {
      testing::Hand hand(scene, source);
      double felt = 0;
      for (double height = 30; height > 2 && felt == 0; height -= 0.01) {
        hand.move_to({0.3, 0.4, side * height});
        if (glm::length(hand.force()) > 0.3) felt = side * hand.proxy_mm().z;
      }
      EXPECT_NEAR(felt, depth, 0.7) << "from " << (side > 0 ? "fat" : "muscle");
    }
  }
}

}  // namespace
}  // namespace palpate::modes
