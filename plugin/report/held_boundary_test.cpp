// The description of the boundary that holds the proxy, against phantoms with known surfaces and contrasts.
#include "plugin/report/held_boundary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "io/fields/boundary_uncertainty.h"
#include "modes/scene/scene_json.h"
#include "modes/tick/haptic_step.h"
#include "plugin/report/summary.h"
#include "solver/chain.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

const modes::Scene& scene() {
  static const modes::Scene skin = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "friction", "strength_n": 0.1},
          {"type": "surface", "name": "skin", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [170, 1.5]]},
           "gates": [{"of": "value", "nodes": [[-510, 0], [-490, 1]]}]}]})",
      "skin");
  return skin;
}

struct PhantomPress {
  testdata::Phantom phantom;
  double noise_hu = 20;
  double from_mm = 24, to_mm = 19;  ///< from the phantom's middle
  bool has_sites = false;
};

/// What is told at the end of a press along a line through the middle of a phantom.
std::optional<HeldBoundary> held_after(const PhantomPress& press) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(press.phantom, testdata::make_geometry({.size = glm::ivec3(56)}), {.noise = press.noise_hu}));
  const modes::SiteMap sites(volume);
  const PreparedScene felt = prepare(scene(), volume, glm::dvec3(0.1));
  solver::Chain chain;
  const auto scratch = std::make_unique<modes::StepScratch>();
  modes::Touch touch;
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, -1, 0.2));
  glm::dvec3 probe_mm(0);
  modes::StepResult result;
  constexpr int steps = 100;
  for (int n = 0; n <= steps; ++n) {
    probe_mm = (press.from_mm + (press.to_mm - press.from_mm) * n / steps) * up;
    result = modes::step(*felt.plan, *felt.source, felt.plan->workspace.to_device(probe_mm), touch, chain, *scratch);
  }
  std::vector<PrimitiveRecord> shares;
  for (std::size_t n = 0; n < result.shares.size(); ++n) {
    PrimitiveRecord share{};
    share.mode = static_cast<decltype(share.mode)>(result.mode_of[n]);
    for (int axis = 0; axis < 3; ++axis) share.force_n[axis] = result.shares[n][axis];
    shares.push_back(share);
  }
  return held_boundary(shares, felt, scene(), felt.plan->workspace.to_patient(result.proxy_m), probe_mm,
                       press.has_sites ? &sites : nullptr);
}

/// Pressed 1 mm beyond the top of a ball of 20 mm.
std::optional<HeldBoundary> pressed_on(double value_hu, double noise_hu) {
  return held_after({.phantom = testdata::make_sphere(20, value_hu), .noise_hu = noise_hu});
}

/// One mode is felt at both, and its name says the outer alone.
TEST(HeldBoundary, IsNamedByTheSiteWhereItIsMet) {
  const auto skin = held_after({.phantom = testdata::make_sphere(20), .has_sites = true});
  ASSERT_TRUE(skin);
  EXPECT_EQ(skin->name, "skin");
  const PhantomPress from_within{.phantom = testdata::make_shell(14, 26), .from_mm = 8, .to_mm = 15, .has_sites = true};
  const auto inside = held_after(from_within);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->name, "air inside the body");
  EXPECT_EQ(in_words(*inside).find("air inside the body, known to"), 0U);
  PhantomPress unknown = from_within;
  unknown.has_sites = false;
  EXPECT_EQ(held_after(unknown).value().name, "skin") << "the mode's own, where no map says more";
}

TEST(HeldBoundary, IsTheSurfaceWithItsWholeStrengthWhereTheContrastIsWhole) {
  const auto held = pressed_on(testdata::soft_tissue_hu, 20);
  ASSERT_TRUE(held);
  EXPECT_EQ(held->mode, 1U);
  EXPECT_EQ(held->full_strength_n, 1.5);
  EXPECT_EQ(held->strength_n, 1.5);
  // 20 HU of 1040 HU over the blur of a voxel: some hundredths of a millimeter, and the voxels' own part.
  ASSERT_TRUE(held->known_to_mm);
  EXPECT_GT(*held->known_to_mm, 0.03);
  EXPECT_LT(*held->known_to_mm, 0.2);
  EXPECT_EQ(in_words(*held).find("skin, known to ±0."), 0U);
  EXPECT_EQ(in_words(*held).find("thin"), std::string::npos);
}

TEST(HeldBoundary, SaysWhatAFaintBoundaryLacksAndThatNoiseMakesItLessKnown) {
  // Steepest gradient of a step of 600 HU at 2 mm: 600 / (2 sqrt(2 pi)) = 120 HU/mm, of which the strength is
  // 1.5 (120 - 20) / 150 N; on a ball of 20 mm the gradient is a little less.
  const auto faint = pressed_on(-400, 20);
  ASSERT_TRUE(faint);
  EXPECT_NEAR(faint->strength_n, 1.0, 0.08);
  EXPECT_NE(in_words(*faint).find(" of its 1.5 N: thin or faint there"), std::string::npos);
  // Felt at -500 to -490 HU, near the middle of a whole contrast; of this one it is five sixths of the way up, and so
  // the place lies about one standard deviation of the voxels' blur in the ball.
  const auto clear = pressed_on(testdata::soft_tissue_hu, 20), noisy = pressed_on(testdata::soft_tissue_hu, 120);
  ASSERT_TRUE(clear && noisy && clear->known_to_mm && noisy->known_to_mm && faint->known_to_mm);
  EXPECT_GT(*noisy->known_to_mm, 1.3 * *clear->known_to_mm);
  EXPECT_GT(*faint->known_to_mm, 0.4);
}

TEST(HeldBoundary, IsNoneWhereNothingHolds) {
  const PreparedScene nothing;
  EXPECT_FALSE(held_boundary({}, nothing, scene(), {}, {}));
}

/// The scan says how well its own boundaries are known. It says nothing of an edge that a person has outlined, also
/// where that lies on a boundary of the scan.
TEST(HeldBoundary, OfAnOutlinedEdgeTheScanSaysNothing) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = glm::ivec3(56)}), {.noise = 30}));
  const PreparedScene felt = prepare(scene(), volume, glm::dvec3(0.1));
  const glm::dvec3 edge_mm(0, -20, 0);
  for (const bool outlined : {false, true}) {
    modes::Scene told = scene();
    if (outlined) told.modes[1].structure = "liver";
    EXPECT_EQ(known_to_mm(felt, told, 1, edge_mm).has_value(), !outlined);
    Summary summary;
    summary.holds = {{.mode = 1, .contact_mm = edge_mm}};
    add_uncertainty(summary, told, *felt.source, volume->geometry);
    EXPECT_EQ(summary.holds[0].known_to_mm.has_value(), !outlined);
  }
}

/// A cubic gradient makes the value cubic, too, whatever the scene asks for; and a place is known as that value shows
/// it.
TEST(HeldBoundary, IsKnownAsTheValueThatIsFeltShowsIt) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = glm::ivec3(56)}), {.noise = 30}));
  const glm::dvec3 edge_mm(0, -20, 0);
  for (const auto gradient : {io::GradientMethod::cubic, io::GradientMethod::gaussian}) {
    modes::Scene sampled = scene();
    sampled.sampling = {.value = io::ValueMethod::trilinear, .gradient = gradient};
    const PreparedScene felt = prepare(sampled, volume, glm::dvec3(0.1));
    const auto by = [&](io::ValueMethod method) {
      return io::uncertainty_at(*felt.source, volume->geometry, method, edge_mm).two_sigma_mm;
    };
    const double cubic = by(io::ValueMethod::cubic), trilinear = by(io::ValueMethod::trilinear);
    ASSERT_NE(cubic, trilinear);
    EXPECT_EQ(known_to_mm(felt, sampled, 1, edge_mm).value(),
              gradient == io::GradientMethod::cubic ? cubic : trilinear);
  }
}

/// Of each tick of a recording how well the boundary that holds the proxy is known there: nothing while a scene changes
/// or where nothing holds; computed anew once the proxy has moved by more than a hand notices.
TEST(HeldBoundary, IsKnownInEachTickAsWellAsAtItsPlace) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = glm::ivec3(56)}), {.noise = 30}));
  const PreparedScene felt = prepare(scene(), volume, glm::dvec3(0.1));
  const auto known = known_to_of_ticks(felt, scene());
  const auto told = [&](const glm::dvec3& place_mm, double force_n = 0.3, std::uint32_t mode = 1, double part = 1) {
    TickRecord tick;
    const glm::dvec3 at = felt.plan->workspace.to_device(place_mm);
    for (int axis = 0; axis < 3; ++axis) tick.proxy_m[axis] = at[axis];
    tick.change_part = part;
    const PrimitiveRecord share{.mode = mode, .force_n = {0, 0, force_n}};
    return known(tick, {&share, 1});
  };
  const auto wanted = [&](const glm::dvec3& place_mm) { return known_to_mm(felt, scene(), 1, place_mm).value(); };
  const glm::dvec3 here(0, -20, 0), there = 20.0 * glm::normalize(glm::dvec3(0.4, -0.8, 0.3));
  ASSERT_NE(wanted(here), wanted(there));
  EXPECT_NEAR(told(here), wanted(here), 1e-9);
  EXPECT_NEAR(told(there), wanted(there), 1e-9);
  EXPECT_EQ(told(there + glm::dvec3(0.015, 0, 0)), told(there)) << "as good as the same place";
  const glm::dvec3 aside = there + glm::dvec3(0.03, 0, 0);
  EXPECT_NEAR(told(aside), wanted(aside), 1e-9);
  EXPECT_NE(wanted(aside), wanted(there));
  EXPECT_TRUE(std::isnan(told(here, 0.3, 1, 0.99))) << "the scene is on its way";
  EXPECT_TRUE(std::isnan(told(here, 0.05))) << "not felt";
  EXPECT_FALSE(std::isnan(told(here, 0.051)));
  EXPECT_TRUE(std::isnan(told(here, 0.3, 0))) << "friction";
}

/// Of several surfaces that push, the one that pushes most holds the proxy, in whatever order they are told.
TEST(HeldBoundary, IsTheSurfaceThatPushesMost) {
  const modes::Scene several = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": 1}, {"type": "surface", "strength_n": 2},
          {"type": "friction", "strength_n": 0.1}, {"type": "surface", "strength_n": 1},
          {"type": "surface", "strength_n": 1}]})",
      "several");
  constexpr std::uint32_t friction = 2;
  const modes::Plan plan = modes::make_plan(several, io::FieldSet::value | io::FieldSet::gradient, {});
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int round = 0; round < 300; ++round) {
    const double scale_n = round % 3 == 0 ? 0.06 : 1;
    std::vector<PrimitiveRecord> shares;
    for (std::uint32_t mode = 0; mode < 5; ++mode) {
      shares.push_back(
          {.mode = mode, .force_n = {scale_n * any(random), scale_n * any(random), scale_n * any(random)}});
    }
    std::shuffle(shares.begin(), shares.end(), random);
    std::map<double, std::size_t> by_force;
    for (const PrimitiveRecord& share : shares) {
      const double force_n = std::hypot(share.force_n[0], share.force_n[1], share.force_n[2]);
      if (share.mode != friction && force_n > 0.05) by_force[force_n] = share.mode;
    }
    const auto wanted = by_force.empty() ? std::nullopt : std::optional<std::size_t>(by_force.rbegin()->second);
    EXPECT_EQ(holding_surface(shares, plan), wanted) << round;
  }
}

}  // namespace
}  // namespace palpate::plugin
