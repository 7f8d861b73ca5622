// Suggestions for scans that are not what a phantom is: tiny, padded, with metal or a coil's shading, in units of any
// size. What is suggested is a valid scene that is read back as it was written, and finds what there is to be found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/scene/suggest.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::air_hu;
using testdata::bone_hu;
using testdata::soft_tissue_hu;

/// Skin, and a skull within: half a millimeter of blur, 20 HU of noise.
io::Volume head(const testdata::Acquisition& acquisition = {.noise = 20}) {
  testdata::Phantom ball = testdata::make_sphere(24);
  ball.bodies.push_back(testdata::make_sphere(16, bone_hu).bodies.front());
  return testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(56)}), acquisition);
}

Suggestion sound_suggestion(io::Volume volume) {
  Suggestion found = suggest(std::make_shared<const io::Volume>(std::move(volume)));
  EXPECT_NO_THROW(validate(found.scene));
  EXPECT_EQ(to_json(scene_from_json(to_json(found.scene), "suggested")), to_json(found.scene));
  EXPECT_FALSE(found.scene.description.empty());
  for (const FoundBoundary& boundary : found.boundaries) {
    EXPECT_TRUE(std::isfinite(boundary.middle));
  }
  return found;
}

bool has_boundary(const Suggestion& found, double low, double high, double tolerance) {
  return std::any_of(found.boundaries.begin(), found.boundaries.end(), [&](const FoundBoundary& boundary) {
    return std::abs(found.typical[boundary.low] - low) < tolerance &&
           std::abs(found.typical[boundary.high] - high) < tolerance;
  });
}

/// Every value changed, in floats; no longer HU.
template <typename SceneChange>
io::Volume changed(const io::Volume& volume, const SceneChange& change) {
  io::Volume made = volume;
  const glm::ivec3 size = volume.geometry.dimensions;
  std::vector<float> values;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        values.push_back(static_cast<float>(change(volume.value_at(i, j, k), glm::ivec3(i, j, k))));
      }
    }
  }
  made.voxels = std::move(values);
  made.slope = 1;
  made.intercept = 0;
  made.unit.clear();
  made.modality = "MR";
  return made;
}

TEST(SuggestOdd, tiny_scans_give_a_scene_whatever_there_is_in_it) {
  for (const glm::ivec3& size : {glm::ivec3(1), glm::ivec3(2, 1, 1), glm::ivec3(3, 4, 1), glm::ivec3(5, 5, 2)}) {
    testdata::Grid grid;
    grid.size = size;
    sound_suggestion(testdata::scan(testdata::make_sphere(1), testdata::make_geometry(grid)));
  }
}

TEST(SuggestOdd, values_of_any_size_give_the_same_tissues) {
  const io::Volume hu = head();
  for (const double unit : {1e-9, 1.0, 1e9}) {
    for (const double offset : {0.0, 1e3}) {
      const Suggestion found =
          sound_suggestion(changed(hu, [&](double value, const glm::ivec3&) { return unit * (value + offset); }));
      ASSERT_EQ(found.boundaries.size(), 2U) << unit;
      EXPECT_TRUE(has_boundary(found, unit * (air_hu + offset), unit * (soft_tissue_hu + offset), 40 * unit)) << unit;
      EXPECT_TRUE(has_boundary(found, unit * (soft_tissue_hu + offset), unit * (bone_hu + offset), 40 * unit)) << unit;
      EXPECT_EQ(found.scene.tissues[0].name, "tissue 1 of 3 (darkest)");
    }
  }
}

TEST(SuggestOdd, metal_does_not_hide_skin_and_bone) {
  testdata::Phantom ball = testdata::make_sphere(24);
  ball.bodies.push_back(testdata::make_sphere(16, bone_hu).bodies.front());
  ball.bodies.push_back(testdata::make_sphere(5, 8000).bodies.front());
  const Suggestion found =
      sound_suggestion(testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(56)}), {.noise = 20}));
  EXPECT_TRUE(has_boundary(found, air_hu, soft_tissue_hu, 60));
  EXPECT_TRUE(has_boundary(found, soft_tissue_hu, bone_hu, 60));
}

TEST(SuggestOdd, padding_is_no_tissue_and_voxels_that_are_no_numbers_are_passed_over) {
  const Suggestion padded = sound_suggestion(head({.noise = 20, .circle_radius = 26}));
  EXPECT_EQ(padded.boundaries.size(), 2U);
  EXPECT_TRUE(has_boundary(padded, air_hu, soft_tissue_hu, 30));
  const Suggestion broken = sound_suggestion(changed(head(), [](double value, const glm::ivec3& at) {
    const bool is_broken = at.x % 17 == 3 && at.y % 13 == 5 && at.z % 11 == 7;
    return is_broken ? std::numeric_limits<double>::quiet_NaN() : value;
  }));
  EXPECT_TRUE(has_boundary(broken, air_hu, soft_tissue_hu, 40));
}

TEST(SuggestOdd, a_coils_shading_across_the_head_leaves_its_surface) {
  // 30 % brighter on one side than in the middle, 30 % darker on the other.
  const Suggestion found = sound_suggestion(changed(
      head(), [](double value, const glm::ivec3& at) { return (value - air_hu) * (1 + 0.3 * (at.x - 27.5) / 27.5); }));
  const bool has_surface = std::any_of(found.boundaries.begin(), found.boundaries.end(), [&](const FoundBoundary& b) {
    return std::abs(found.typical[b.low]) < 60 && found.typical[b.high] > 700;
  });
  EXPECT_TRUE(has_surface);
  EXPECT_LE(found.boundaries.size(), 6U);
}

}  // namespace
}  // namespace palpate::modes
