// The ways of single places to the scan's edge.
#include "io/structures/edge_ways.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

using internal::EdgeWay;
using internal::EdgeWays;

constexpr double radius_mm = 12;

/// A ball of 100 in 0, blurred: an analytic scan.
class BallScan final : public FieldSource {
 public:
  FieldSet available() const noexcept override { return FieldSet::value | FieldSet::gradient; }
  Sample sample(const Vec3& at, FieldSet /*wanted*/) const noexcept override {
    constexpr double blur_mm = 0.8;
    const double r = glm::length(at), depth = (radius_mm - r) / blur_mm;
    const double slope = 100 / (blur_mm * std::sqrt(2 * std::numbers::pi)) * std::exp(-0.5 * depth * depth);
    Sample sample;
    sample.inside = true;
    sample.value = 50 * (1 + std::erf(depth / std::numbers::sqrt2));
    sample.gradient = r > 0 ? -at / r * slope : Vec3(0);
    return sample;
  }
};

// Whichever place it is, the first one too: halved, or none where it ends.
TEST(EdgeWays, APlaceInDoubtIsHeldBack) {
  Geometry geometry;
  geometry.dimensions = {60, 60, 60};
  for (int k = 0; k < 60; ++k) geometry.slice_positions.emplace_back(-30, -30, k - 30);
  const BallScan values;
  const ScanValues scan{values, geometry};
  const ScanEdgeEdit edit{.center_mm = Vec3(0), .radius_mm = 30, .most_mm = 3};
  for (const Vec3& off : {Vec3(0, 0, 1.5), Vec3(0.2, -0.1, -1.5)}) {
    const auto outlined = [&](const Vec3& at) { return glm::distance(at, off) < radius_mm; };
    const auto field = distance_of(made_labels(outlined, radius_mm + 8));
    const EdgeWays all(*field, edit, scan, 0);
    const std::size_t count = all.places().size();
    ASSERT_GT(count, 100U);
    ASSERT_GT(std::abs(all.places().front().mm), 0.5);
    ASSERT_GT(std::abs(all.places().back().mm), 0.5);
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, count / 3, count / 2, count - 2, count - 1}) {
      const EdgeWay& before = all.places()[n];
      EdgeWays ended = all, halved = all;
      const std::vector<Vec3> doubt{before.at.place_mm};
      EXPECT_EQ(ended.hold_back(doubt, *field, true), halved.hold_back(doubt, *field, false)) << n;
      EXPECT_EQ(ended.places()[n].mm, 0) << n;
      EXPECT_LE(std::abs(halved.places()[n].mm), 0.5 * std::abs(before.mm) + 1e-12) << n;
      // Ended once, it has no way left to be held back.
      EXPECT_FALSE(ended.hold_back(doubt, *field, true)) << n;
    }
  }
}

}  // namespace
}  // namespace palpate::io
