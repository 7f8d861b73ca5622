/// What a surface takes ahead, by the balance of a slow push: the proxy rests at w while the probe is s(w) / k ahead of
/// it, and where w + s(w) / k falls behind what it was, the proxy jumps at one force of the probe.

#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/session/strength_ahead.h"

namespace palpate::plugin {
namespace {

/// A surface that takes a newton for each unit of the gradient's length, which is given along a way.
class Profile final : public io::FieldSource {
 public:
  Profile(std::function<double(double)> strength_n, const glm::dvec3& from_mm, const glm::dvec3& along)
      : strength_n_(std::move(strength_n)), from_mm_(from_mm), along_(along) {}
  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::gradient; }
  io::Sample sample(const io::Vec3& at, io::FieldSet) const noexcept override {
    ++samples;
    io::Sample sample;
    sample.inside = true;
    sample.gradient = strength_n_(glm::dot(at - from_mm_, along_)) * along_;
    return sample;
  }
  mutable int samples = 0;

 private:
  std::function<double(double)> strength_n_;
  glm::dvec3 from_mm_, along_;
};

const glm::dvec3 begin_mm(3, -4, 5), inward = glm::normalize(glm::dvec3(1, 2, -2));

/// `n_per_mm` of the coupling, in the patient's millimeters: the hand's are others.
double ahead(const std::function<double(double)>& strength_n, double n_per_mm, int* samples = nullptr) {
  const Profile source(strength_n, begin_mm, inward);
  modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[0, 0], [10, 10]]}}]})",
      "test");
  modes::Workspace workspace;
  workspace.mm_per_m = 1700;
  scene.stiffness_n_per_m = 1700 * n_per_mm;
  const modes::Plan plan = modes::make_plan(scene, source.available(), workspace);
  const double strongest = strength_ahead_n(plan.modes.at(0), plan, source, begin_mm, inward);
  if (samples != nullptr) *samples = source.samples;
  return strongest;
}

/// Three millimeters, in steps of a tenth, both ends included.
TEST(StrengthAheadBalance, LooksThreeMillimetersAhead) {
  int samples = 0;
  EXPECT_EQ(ahead([](double) { return 0; }, 0.4, &samples), 0);
  EXPECT_EQ(samples, 31);
  for (const auto& [middle_mm, is_met] : {std::pair{0.0, true},
                                          {0.5, true},
                                          {1.55, false},
                                          {2.9, true},
                                          {3.0, true},
                                          {3.1, false},
                                          {5.0, false},
                                          {-0.1, false},
                                          {-1.0, false}}) {
    const double at = middle_mm;
    const double strongest = ahead([at](double w) { return std::abs(w - at) < 0.03 ? 1.3 : 0; }, 0.4);
    EXPECT_NEAR(strongest, is_met ? 1.3 : 0, 1e-12) << middle_mm;
  }
}

/// Behind a plate the proxy jumps to the next one, and the force falls by k times the way: what lies farther than half
/// of the plate's strength is behind a break-through, and what lies nearer is counted.
TEST(StrengthAheadBalance, WhatIsBehindAGapCountsWhileHalfOfTheForceIsLeft) {
  std::mt19937 random(1);
  int counted = 0, behind = 0;
  for (int n = 0; n < 400; ++n) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const double k = between(0.25, 0.8), plate_n = between(0.3, 1.6), wall_n = plate_n * between(1.05, 2);
    const double begin = between(0, 0.4), end = begin + between(0.25, 0.6), gap = between(0.15, 3);
    const double farthest = plate_n / (2 * k);
    if (std::abs(gap - farthest) < 0.21 || farthest < 0.3 || end + gap > 2.8) continue;  // the steps' width
    const double strongest =
        ahead([&](double w) { return w >= begin && w <= end ? plate_n
                                     : w >= end + gap       ? wall_n
                                                            : 0.0; }, k);
    ASSERT_NEAR(strongest, gap < farthest ? wall_n : plate_n, 1e-9) << gap << " of " << farthest;
    ++(gap < farthest ? counted : behind);
  }
  EXPECT_GT(counted, 20);
  EXPECT_GT(behind, 20);
}

/// From an edge where the strength falls to a part of it, the proxy jumps by (s - s') / k, and s - s' of the force is
/// gone: more than half, and what lies behind is not counted; less, and it is.
TEST(StrengthAheadBalance, AFallToLessThanHalfIsABreakThrough) {
  std::mt19937 random(2);
  int counted = 0, behind = 0;
  for (int n = 0; n < 400; ++n) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const double k = between(0.4, 0.9), first_n = between(0.3, 1.0), part = between(0, 1), last_n = first_n * 1.7;
    const double edge = between(0.15, 0.6), jump = (1 - part) * first_n / k, half = first_n / (2 * k);
    const double wall = edge + std::max(jump, half) + 0.25;  // behind both
    if (std::abs(part - 0.5) < 0.05 || wall > 2.8 || std::abs(jump - half) < 0.25) continue;
    const double strongest =
        ahead([&](double w) { return w <= edge  ? first_n
                                     : w < wall ? part * first_n
                                                : last_n; }, k);
    ASSERT_NEAR(strongest, part > 0.5 ? last_n : first_n, 1e-9) << part << " " << jump << " " << half;
    ++(part > 0.5 ? counted : behind);
  }
  EXPECT_GT(counted, 20);
  EXPECT_GT(behind, 20);
}

/// Where the strength falls more gently than the coupling, the proxy follows without a jump, and all counts.
TEST(StrengthAheadBalance, AGentleFallIsNoBreakThrough) {
  for (const double k : {0.3, 0.6, 1.1}) {
    const double gentle = ahead([k](double w) { return w < 2.75 ? 1.5 - 0.9 * k * w : 2.2; }, 0.999 * k);
    EXPECT_NEAR(gentle, 1.5 - 0.9 * k * 2.7 > 0 ? 2.2 : gentle, 1e-9) << k;
    EXPECT_NEAR(ahead([k](double w) { return std::max(0.0, 1.5 - 8 * k * w); }, k), 1.5, 1e-9);
  }
}

/// Where the strength has fallen to nothing without a jump, the proxy is free and goes on with the probe: what lies
/// behind, however far, counts as what lies before the first wall does.
TEST(StrengthAheadBalance, BehindAGentleFallToNothingAllCounts) {
  std::mt19937 random(4);
  for (int n = 0; n < 100; ++n) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const double k = between(0.4, 1.2), fall = between(0.5, 0.9) * k, free_mm = between(0.5, 1.2);
    const double first_n = fall * free_mm, wall_mm = between(free_mm + 0.2, 2.8), wall_n = first_n * between(1.1, 2);
    const double strongest =
        ahead([&](double w) { return w >= wall_mm ? wall_n : std::max(0.0, first_n - fall * w); }, k);
    ASSERT_NEAR(strongest, wall_n, 1e-9) << "free from " << free_mm << " mm on, a wall at " << wall_mm;
  }
}

/// Which way a surface resists, of a rise of the scan's own values or of a structure's distance along the push. Across
/// the push there is no rise.
TEST(StrengthAheadBalance, ResistsOnItsOwnSide) {
  io::Sample sample;
  sample.inside = true;
  const glm::dvec3 up(0, 0.6, 0.8), across(1, 0, 0);
  for (const int structure : {-1, 0, 1}) {
    for (const modes::Side side : {modes::Side::entering, modes::Side::leaving, modes::Side::both}) {
      modes::Scene scene =
          modes::scene_from_json(R"({"version": 1, "modes": [{"type": "surface", "strength_n": 1.25}]})", "test");
      modes::Plan plan = modes::make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, {});
      modes::ActiveMode& mode = plan.modes.at(0);
      mode.side = side;
      mode.structure = structure;
      const auto set = [&](const glm::dvec3& rise) {
        sample.gradient = structure < 0 ? rise : -rise;  // the others say the opposite
        for (int n = 0; n < 2; ++n) {
          sample.distance[static_cast<std::size_t>(n)].gradient = n == structure ? rise : -rise;
        }
      };
      set(3.0 * up);
      EXPECT_EQ(strength_against_n(mode, sample, up), side == modes::Side::leaving ? 0 : 1.25);
      EXPECT_EQ(strength_against_n(mode, sample, -up), side == modes::Side::entering ? 0 : 1.25);
      EXPECT_EQ(strength_against_n(mode, sample, across), side == modes::Side::both ? 1.25 : 0);
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
