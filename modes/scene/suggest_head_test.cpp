// Suggestions on real scans: a head CT (Debian's invesalius-examples), and an MR series where it is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>

#include "io/fields/volume_fields.h"
#include "io/load.h"
#include "io/series.h"
#include "modes/scene/suggest.h"
#include "modes/testing/test_rig.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/invesalius.h"

namespace palpate::modes {
namespace {

/// The boundary between two tissues whose typical values lie in these ranges.
std::optional<FoundBoundary> between(const Suggestion& found, const std::array<double, 2>& low,
                                     const std::array<double, 2>& high) {
  for (const FoundBoundary& boundary : found.boundaries) {
    const double from = found.typical[boundary.low], to = found.typical[boundary.high];
    if (from >= low[0] && from <= low[1] && to >= high[0] && to <= high[1]) {
      return boundary;
    }
  }
  return std::nullopt;
}

/// The scan as it is, between its voxels as simply as can be: what is held to be true.
io::VolumeFields truth_of(const std::shared_ptr<const io::Volume>& volume) {
  return {volume, io::FieldSet::value, 0, {.value = io::ValueMethod::trilinear}};
}

/// Where a ray inwards first reaches a value, mm along it.
double crossing_mm(const io::FieldSource& truth, const Vec3& from, const Vec3& inward, double value, double begin) {
  for (double along = begin; along < 90; along += 0.02) {
    if (truth.sample(from + along * inward, io::FieldSet::value).value >= value) {
      return along;
    }
  }
  return -1;
}

/// Where a stylus that goes inwards is first held by more than 0.1 N, mm along its way; -1: never.
double felt_mm(const Suggestion& found, const FoundBoundary& alone, const io::FieldSource& source, const Vec3& from,
               const Vec3& inward, double depth_mm) {
  Scene scene = found.scene;
  for (std::size_t m = 0; m < scene.modes.size(); ++m) {
    scene.modes[m].enabled = m == alone.mode;
  }
  testing::Hand hand(scene, source);
  for (double along = 0; along < depth_mm; along += 0.02) {
    hand.move_to(from + along * inward);
    if (glm::length(hand.force()) > 0.1) {
      return glm::dot(hand.proxy_mm() - from, inward);
    }
  }
  return -1;
}

TEST(SuggestHead, offers_skin_and_skull_as_two_boundaries_each_felt_without_the_other_where_it_is) {
  if (!std::filesystem::exists(testdata::invesalius_cranium)) {
    GTEST_SKIP() << "needs the real head of Debian's invesalius-examples, which is not at "
                 << testdata::invesalius_cranium;
  }
  const auto head = std::make_shared<const io::Volume>(testdata::read_invesalius(testdata::invesalius_cranium));
  const Suggestion found = suggest(head);
  const auto skin = between(found, {-1100, -900}, {-50, 100});
  const auto skull = between(found, {-50, 100}, {700, 2000});
  ASSERT_TRUE(skin);
  ASSERT_TRUE(skull);
  EXPECT_NE(found.scene.modes[skin->mode].color, found.scene.modes[skull->mode].color);
  const io::VolumeFields source(head, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high,
                                io::default_gradient_scale_mm(head->geometry));
  const io::VolumeFields truth = truth_of(head);
  const Vec3 inward(0, 1, 0);  // to the back: the rays meet the forehead above the sinuses
  for (int ray = 0; ray < repeats(20, 2); ++ray) {
    const double x = -20.0 + 10.0 * (ray % 5), z = 35.0 + 5.0 * (ray / 5);
    SCOPED_TRACE(::testing::Message() << "L " << x << " H " << z << " mm");
    const Vec3 from(x, -110, z);
    const double skin_mm = crossing_mm(truth, from, inward, -300, 0);
    const double skull_mm = crossing_mm(truth, from, inward, 300, skin_mm);
    ASSERT_GT(skin_mm, 0);
    ASSERT_GT(skull_mm, skin_mm + 1);
    EXPECT_NEAR(felt_mm(found, *skin, source, from, inward, skin_mm + 20), skin_mm, 1);
    EXPECT_NEAR(felt_mm(found, *skull, source, from, inward, skull_mm + 20), skull_mm, 1);
  }
}

TEST(SharedSuggestHead, offers_the_scalp_and_the_surface_of_the_brain_of_an_mr) {
  const std::filesystem::path folder = std::filesystem::path(PALPATE_SHARED_DATA) / "mr_t1_ax_384";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "needs the shared MR head, a real brain to be suggested boundaries of, which is not at " << folder;
  }
  if (is_sanitized) {
    GTEST_SKIP() << "under sanitizers the CT head stands for both: this one takes a minute, and runs the same code";
  }
  const io::Catalogue catalogue = io::find_series(std::array{folder});
  ASSERT_FALSE(catalogue.series.empty());
  const auto head = std::make_shared<const io::Volume>(io::load(catalogue.series.front()));
  const Suggestion found = suggest(head);
  // Dark (air, bone, fluid), the brain's gray matter and the scalp, white matter and fat.
  const auto scalp_and_brain = between(found, {0, 15}, {30, 50});
  ASSERT_TRUE(scalp_and_brain);
  EXPECT_TRUE(between(found, {30, 50}, {60, 85}));
  const io::VolumeFields source(head, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high,
                                io::default_gradient_scale_mm(head->geometry));
  const io::VolumeFields truth = truth_of(head);
  // From the left, level with the middle of the scan: the scalp, and beneath it and the skull the brain.
  const io::Geometry& g = head->geometry;
  const Vec3 middle = g.to_patient(0.5 * Vec3(g.dimensions - 1));
  const Vec3 inward(-1, 0, 0);
  const Vec3 from = middle - 115.0 * inward;
  const double scalp_mm = crossing_mm(truth, from, inward, scalp_and_brain->middle, 0);
  ASSERT_GT(scalp_mm, 0);
  EXPECT_NEAR(felt_mm(found, *scalp_and_brain, source, from, inward, scalp_mm + 20), scalp_mm, 1);
  // From within the skull, which is dark: the next that is felt is the brain.
  double skull_mm = scalp_mm + 2;
  while (truth.sample(from + skull_mm * inward, io::FieldSet::value).value > 10) {
    skull_mm += 0.02;
    ASSERT_LT(skull_mm, scalp_mm + 15);
  }
  const double brain_mm = crossing_mm(truth, from, inward, scalp_and_brain->middle, skull_mm);
  EXPECT_GT(brain_mm, scalp_mm + 4);
  EXPECT_NEAR(felt_mm(found, *scalp_and_brain, source, from + skull_mm * inward, inward, 25) + skull_mm, brain_mm, 1);
}

}  // namespace
}  // namespace palpate::modes
