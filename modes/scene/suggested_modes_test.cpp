// What the modes and tissues of a suggested scene say, on phantoms of known tissues: where friction is felt, how hard a
// boundary is, and what each tissue is called.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/scene/defaults.h"
#include "modes/scene/suggest.h"
#include "modes/testing/test_rig.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::HalfSpace;

std::shared_ptr<const io::Volume> scan_of(const testdata::Phantom& phantom, double noise) {
  return std::make_shared<const io::Volume>(
      testdata::scan(phantom, testdata::make_geometry(testdata::Grid{}), {.noise = noise}));
}

/// Layers under z = 20, 8, -4 and -16 mm.
testdata::Phantom layers_of(const std::vector<double>& values) {
  testdata::Phantom phantom{.background = values.front(), .bodies = {}};
  for (std::size_t n = 1; n < values.size(); ++n) {
    phantom.bodies.push_back({HalfSpace{{0, 0, 1}, 32.0 - 12 * static_cast<double>(n)}, values[n]});
  }
  return phantom;
}

/// What the suggested friction takes from a hand that slides by 10 mm along the layers at that height, N.
double friction_at(const Suggestion& found, const io::FieldSource& source, double height_mm) {
  Scene scene = found.scene;
  for (Mode& mode : scene.modes) mode.enabled = mode.type == "friction";
  testing::Hand hand(scene, source);
  hand.stroke({-5, 2, height_mm}, {5, 2, height_mm}, 500);
  return glm::length(hand.force());
}

TEST(SuggestedModes, HandIsFreeInTheAirAndDragsFromTheSkinOn) {
  const auto volume = scan_of(layers_of({testdata::air_hu, testdata::soft_tissue_hu, testdata::bone_hu}), 10);
  const Suggestion found = suggest(volume);
  const io::VolumeFields source(volume, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high,
                                io::default_gradient_scale_mm(volume->geometry));
  EXPECT_EQ(std::ranges::count(found.scene.modes, "friction", &Mode::type), 1);
  for (const double in_air : {29.0, 26.0, 23.0}) EXPECT_EQ(friction_at(found, source, in_air), 0) << in_air;
  for (const double in_body : {17.0, 14.0, 11.0, 4.0, -10.0, -28.0}) {
    EXPECT_NEAR(friction_at(found, source, in_body), defaults::friction_strength_n, 1e-9) << in_body;
  }
}

/// The darkest boundary is felt first, also where it is a small one: a bubble above a floor.
TEST(SuggestedModes, FrictionIsThatOfTheDarkestBoundaryHoweverSmallItIs) {
  int small = 0;
  for (const double radius_mm : {10.0, 15.0}) {
    const testdata::Phantom phantom{.background = testdata::soft_tissue_hu,
                                    .bodies = {{testdata::Ball{{0, 0, 6}, radius_mm}, testdata::air_hu},
                                               {HalfSpace{{0, 0, 1}, -20}, testdata::bone_hu}}};
    const Suggestion found = suggest(std::make_shared<const io::Volume>(
        testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(48)}), {.noise = 5})));
    ASSERT_EQ(found.boundaries.size(), 2U) << radius_mm;
    const auto darkest = std::ranges::min_element(found.boundaries, {}, &FoundBoundary::middle);
    small += darkest != found.boundaries.begin() ? 1 : 0;  // the largest comes first
    const auto friction = std::ranges::find(found.scene.modes, "friction", &Mode::type);
    ASSERT_NE(friction, found.scene.modes.end());
    const double step = found.typical[darkest->high] - found.typical[darkest->low];
    EXPECT_NEAR(friction->strength_n.nodes()[0].at, darkest->middle - 0.08 * step, 1) << radius_mm;
    EXPECT_NEAR(friction->strength_n.nodes()[1].at, darkest->middle + 0.02 * step, 1) << radius_mm;
  }
  EXPECT_GT(small, 0);
}

/// A vessel with contrast medium may be brighter than cancellous bone. Its wall is within soft tissue and as soft.
TEST(SuggestedModes, WallWithinATissueIsNotAsHardAsBone) {
  int walls = 0;
  for (const double bright : {160.0, 165.0, 170.0}) {
    const testdata::Phantom phantom{.background = testdata::air_hu,
                                    .bodies = {{HalfSpace{{0, 0, 1}, 26}, 60},
                                               {HalfSpace{{0, 0, 1}, 14}, bright},
                                               {HalfSpace{{0, 0, 1}, 4}, 60},
                                               {HalfSpace{{0, 0, 1}, -22}, testdata::bone_hu}}};
    const Suggestion found = suggest(scan_of(phantom, 5));
    for (const FoundBoundary& boundary : found.boundaries) {
      if (boundary.within.empty()) continue;
      walls += found.typical[boundary.high] > 150 ? 1 : 0;
      EXPECT_EQ(found.scene.modes[boundary.mode].strength_n.maximum(), defaults::skin_strength_n) << bright;
    }
  }
  EXPECT_GT(walls, 0) << "else no wall was bright";
}

TEST(SuggestedModes, DenseBoneBeginsAboveTheFainterBone) {
  testdata::Phantom phantom = layers_of({testdata::air_hu, testdata::soft_tissue_hu, testdata::soft_tissue_hu, 1000});
  phantom.bodies.push_back({testdata::Ball{{0, 0, 8}, 7}, 400});
  const Suggestion found = suggest(scan_of(phantom, 10));
  const auto near = [](double one, double other) { return std::abs(one - other) < 30; };
  int dense = 0;
  for (const FoundBoundary& boundary : found.boundaries) {
    const double low = found.typical[boundary.low], high = found.typical[boundary.high];
    if (!near(low, testdata::soft_tissue_hu) || high < 200) continue;
    if (near(high, 400)) {
      EXPECT_LT(boundary.middle, 0.5 * (low + high)) << "bone begins nearer to soft tissue";
    } else {
      ++dense;
      EXPECT_TRUE(near(high, 1000)) << high;
      EXPECT_GT(boundary.middle, 400 + 50);
    }
  }
  EXPECT_EQ(dense, 1);
}

TEST(SuggestedModes, TissuesWithoutHuAreRankedFromTheDarkestToTheBrightest) {
  const std::vector<double> values{0, 300, 500, 800, 1000};
  for (std::size_t count = 2; count <= values.size(); ++count) {
    io::Volume volume = *scan_of(layers_of({values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)}), 3);
    volume.unit.clear();
    volume.modality = "MR";
    const Suggestion found = suggest(std::make_shared<const io::Volume>(std::move(volume)));
    ASSERT_EQ(found.scene.tissues.size(), count);
    for (std::size_t t = 0; t < count; ++t) {
      const std::string rank = "tissue " + std::to_string(t + 1) + " of " + std::to_string(count);
      EXPECT_EQ(found.scene.tissues[t].name, rank + (t == 0 ? " (darkest)" : t == count - 1 ? " (brightest)" : ""));
      EXPECT_NEAR(found.typical[t], values[t], 20);
    }
  }
}

TEST(SuggestedModes, SidesOfAFaintWallAreCalledDarkerAndBrighter) {
  const testdata::Phantom phantom{.background = testdata::air_hu,
                                  .bodies = {{HalfSpace{{0, 0, 1}, 26}, 40},
                                             {HalfSpace{{0, 0, 1}, 9}, 100},
                                             {HalfSpace{{0, 0, 1}, 2}, 40},
                                             {HalfSpace{{0, 0, 1}, -22}, testdata::bone_hu}}};
  const Suggestion found = suggest(scan_of(phantom, 5));
  const auto wall = std::ranges::find_if(found.boundaries, [](const FoundBoundary& b) { return !b.within.empty(); });
  ASSERT_NE(wall, found.boundaries.end());
  const auto called = [&](std::size_t side, const std::string& which) {
    EXPECT_EQ(found.scene.tissues[side].name,
              wall->within + ", " + which + " part (" + std::to_string(std::lround(found.typical[side])) + ")");
  };
  EXPECT_LT(found.typical[wall->low], found.typical[wall->high]);
  called(wall->low, "darker");
  called(wall->high, "brighter");
}

/// What is brighter than any soft tissue is bone and is hard; skin is not.
TEST(SuggestedModes, ABoundaryIsHardWhereItsHigherSideIsBone) {
  for (const double value : {-50.0, 60.0, 700.0, 1200.0}) {
    const Suggestion found = suggest(scan_of(layers_of({testdata::air_hu, value, value, value}), 5));
    ASSERT_EQ(found.boundaries.size(), 1U) << value;
    EXPECT_EQ(found.scene.modes[found.boundaries[0].mode].strength_n.maximum(),
              value > 150 ? defaults::bone_strength_n : defaults::skin_strength_n)
        << value;
  }
}

}  // namespace
}  // namespace palpate::modes
