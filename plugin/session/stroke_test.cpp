// What a stroke tells of a boundary's strength: all of it at a thick wall, less at a plate thinner than the gradient's
// scale.
#include "plugin/session/stroke.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/session/prepared_scene.h"
#include "testdata/analytic.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// The first contact with bone on the way along -z into a wall of bone that is so thick.
Contact contact_with_bone(double thickness_mm) {
  const std::array layers{testdata::Layer{-10, testdata::soft_tissue_hu}, testdata::Layer{0, testdata::bone_hu},
                          testdata::Layer{thickness_mm, testdata::soft_tissue_hu}};
  const testdata::Phantom phantom = testdata::make_slab({0, 0, -1}, layers);
  const auto volume = std::make_shared<io::Volume>(
      testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(40), .spacing = glm::dvec3(1)})));
  const modes::Scene scene = modes::load_scene("ct-bone");
  const PreparedScene felt = prepare(scene, volume, glm::dvec3(0.1));
  const auto stroke = run_stroke(*felt.plan, *felt.source, {0.2, 0.3, 6}, {0.2, 0.3, -4}, 20);
  auto contacts = contacts_of(stroke, *felt.plan, met_n);
  add_strengths(contacts, stroke, *felt.plan, *felt.source);
  EXPECT_FALSE(contacts.empty());
  return contacts.empty() ? Contact{} : contacts.front();
}

TEST(Stroke, AThickWallTakesItsFullStrengthAndAThinPlateLessWhichIsSaid) {
  const Contact thick = contact_with_bone(12);
  EXPECT_GT(thick.strength_n, 0.95 * thick.full_strength_n);
  EXPECT_EQ(strength_to_text(thick), "");
  const Contact thin = contact_with_bone(1.0);
  EXPECT_LT(thin.strength_n, 0.75 * thin.full_strength_n);
  EXPECT_GT(thin.strength_n, 0);
  EXPECT_NE(strength_to_text(thin).find("thin or faint there"), std::string::npos);
  // The wall yields where the pull exceeds what it takes and the scene's friction of at most 0.1 N.
  EXPECT_GT(thin.peak_n, 0.95 * thin.strength_n);
  EXPECT_LT(thin.peak_n, thin.strength_n + 0.1 + 0.001);
}

/// Noted from a hundredth to three quarters of what the boundary could give; of one that gives nothing there is no
/// part.
TEST(Stroke, WhatIsThinIsSaidWithItsPart) {
  EXPECT_EQ(strength_to_text(0.5, 2), "; 0.25 of its 2 N: thin or faint there");
  for (const double full_n : {0.5, 4.0}) {
    for (const auto& [part, told] :
         {std::pair{0.0, false}, {0.009, false}, {0.011, true}, {0.74, true}, {0.76, false}, {1.0, false}}) {
      EXPECT_EQ(strength_to_text(part * full_n, full_n) != "", told) << part;
    }
  }
  EXPECT_EQ(strength_to_text(0, 0), "");
  EXPECT_EQ(strength_to_text(0.1, 0), "");
}

/// A contact is a stretch in which one surface pushes with more than the threshold; what is no surface makes none.
TEST(Stroke, ContactsAreStretchesOfOneSurface) {
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": 1}, {"type": "friction", "strength_n": 1},
          {"type": "surface", "strength_n": 2}]})",
      "test");
  const modes::Plan plan = modes::make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, {});
  std::vector<StrokePoint> stroke(60);
  const auto push = [&](std::size_t begin, std::size_t end, std::size_t mode, double newtons) {
    for (std::size_t n = begin; n < end; ++n) {
      stroke[n].boundary = mode;
      stroke[n].force_n = {0, newtons, 0};
    }
  };
  push(5, 10, 0, 0.3);
  stroke[7].force_n = {0.3, 0, -0.4};  // 0.5 N
  push(10, 15, 2, 0.2);
  push(20, 25, 1, 9);     // friction
  push(30, 35, 0, 0.05);  // not more than the threshold
  push(40, 41, 0, 0.06);
  push(45, 60, 0, 0.7);
  const std::vector<Contact> contacts = contacts_of(stroke, plan, 0.05);
  struct Wanted {
    std::size_t boundary, first, last;
    double peak_n;
  };
  const std::vector<Wanted> wanted{{0, 5, 9, 0.5}, {2, 10, 14, 0.2}, {0, 40, 40, 0.06}, {0, 45, 59, 0.7}};
  ASSERT_EQ(contacts.size(), wanted.size());
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    EXPECT_EQ(contacts[n].boundary, wanted[n].boundary) << n;
    EXPECT_EQ(contacts[n].first, wanted[n].first) << n;
    EXPECT_EQ(contacts[n].last, wanted[n].last) << n;
    EXPECT_NEAR(contacts[n].peak_n, wanted[n].peak_n, 1e-12) << n;
  }
}

/// The slab with an end and with two structures, whose distances tell the place; its values may be no numbers below a
/// height.
class EndingSlab final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override {
    return slab_.available() | io::FieldSet::distance | io::FieldSet::vector;
  }
  io::Sample sample(const io::Vec3& at, io::FieldSet wanted) const noexcept override {
    if (at.z > 9) return {};
    io::Sample sample = slab_.sample(at, wanted);
    for (int n = 0; n < 2; ++n) sample.distance[static_cast<std::size_t>(n)].mm = at.x + (n + 1) * at.z;
    if (at.z < broken_below_mm) sample.vector = io::Vec3(std::numeric_limits<double>::infinity(), 0, 0);
    return sample;
  }
  double broken_below_mm = -std::numeric_limits<double>::infinity();

 private:
  testdata::AnalyticSource slab_{testdata::make_slab(glm::normalize(glm::dvec3(0.2, 0.1, -1)),
                                                     std::array{testdata::Layer{0, testdata::soft_tissue_hu},
                                                                testdata::Layer{6, testdata::bone_hu}}),
                                 1.5};
};

TEST(Stroke, WithoutAPointTellsNoStrength) {
  const EndingSlab source;
  const modes::Plan plan = modes::make_plan(modes::load_scene("ct-skin-and-bone"), source.available(), {});
  std::array<Contact, 1> contacts{Contact{.first = 0, .last = 0, .peak_n = 1}};
  const double before = contacts[0].strength_n;
  add_strengths(contacts, {}, plan, source);
  EXPECT_EQ(contacts[0].strength_n, before);
  EXPECT_TRUE(contacts_of({}, plan, met_n).empty());
}

TEST(Stroke, WhatCannotBeSolvedIsRefusedWithItsPlace) {
  EndingSlab source;
  source.broken_below_mm = 3;
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "force", "field": "vector", "strength_n": 0.5}]})", "force");
  const modes::Plan plan = modes::make_plan(scene, source.available(), {});
  try {
    run_stroke(plan, source, {0, 0, 8}, {0, 0, 0}, 8);
    FAIL() << "not refused";
  } catch (const std::runtime_error& error) {
    const std::string said = error.what();
    const std::size_t at = said.find("0.000, 0.000, ");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_NEAR(std::stod(said.substr(at + 14)), 3, 0.1) << said;
  }
}

/// Each point of a stroke in a reach that is turned, moved and scaled: even steps of a millisecond, the coupling's
/// force in the patient, the scan at the proxy and at the probe, and who pushes most.
TEST(Stroke, EveryPointSaysWhatIsThere) {
  const EndingSlab source;
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.stiffness_n_per_m = 520;
  modes::Workspace workspace;
  workspace.center_mm = {3, -4, 5};
  workspace.rotation = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  workspace.mm_per_m = 1700;
  modes::Plan plan = modes::make_plan(scene, source.available(), workspace);
  plan.structures = {0, 1};
  const glm::dvec3 from(1, 2, 11), to(-2, 1, -12.5);
  constexpr double speed = 43;
  const std::vector<StrokePoint> stroke = run_stroke(plan, source, from, to, speed);
  const double ticks = std::ceil(glm::distance(from, to) / speed * 1000);
  ASSERT_EQ(stroke.size(), static_cast<std::size_t>(ticks) + 1);
  EXPECT_EQ(stroke.back().position_mm, to);
  const double n_per_mm = scene.stiffness_n_per_m / workspace.mm_per_m;
  int held = 0, apart = 0, outside = 0;
  for (std::size_t n = 0; n < stroke.size(); ++n) {
    const StrokePoint& point = stroke[n];
    const auto value_at = [&](const glm::dvec3& at) {
      return at.z > 9 ? std::nan("") : source.sample(at, io::FieldSet::value).value;
    };
    const auto is_same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    ASSERT_LT(glm::distance(point.position_mm, from + static_cast<double>(n) / ticks * (to - from)), 1e-9) << n;
    ASSERT_LT(glm::distance(point.force_n, n_per_mm * (point.proxy_mm - point.position_mm)), 1e-9) << n;
    ASSERT_TRUE(is_same(point.value, value_at(point.proxy_mm))) << n;
    ASSERT_TRUE(is_same(point.value_passed, value_at(point.position_mm))) << n;
    if (point.proxy_mm.z <= 9) {
      ASSERT_NEAR(point.distance_mm[0], point.proxy_mm.x + point.proxy_mm.z, 1e-9);
      ASSERT_NEAR(point.distance_mm[1], point.proxy_mm.x + 2 * point.proxy_mm.z, 1e-9);
    }
    ASSERT_EQ(point.boundary.has_value(), point.primitive.has_value());
    if (glm::length(point.force_n) > 0.2) {
      ASSERT_TRUE(point.boundary) << n;
    }
    held += point.boundary ? 1 : 0;
    apart += point.value != point.value_passed ? 1 : 0;
    outside += std::isnan(point.value) ? 1 : 0;
  }
  EXPECT_GT(held, 100);
  EXPECT_GT(apart, 100);
  EXPECT_GT(outside, 10);
}

}  // namespace
}  // namespace palpate::plugin
