// The reach of a Gaussian across slices, and the metadata of a filtered scan.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "io/fields/filtered.h"

namespace palpate::io {
namespace {

/// Slices that are each of one value, so that only what lies across them is filtered. Slice positions and voxels have a
/// slice more behind their ends, of a value that must not be met.
Volume slices_of_values(const std::vector<double>& heights, const std::vector<double>& values, double lean) {
  Volume volume;
  Geometry& g = volume.geometry;
  g.dimensions = {5, 4, static_cast<int>(heights.size())};
  g.uniform = false;
  std::vector<float> voxels;
  for (std::size_t k = 0; k <= heights.size(); ++k) {
    const double height = k < heights.size() ? heights[k] : heights.back() + 0.1;
    g.slice_positions.emplace_back(lean * height, 0, height);
    voxels.insert(voxels.end(), 20, k < values.size() ? static_cast<float>(values[k]) : 1e6F);
  }
  g.slice_positions.pop_back();
  voxels.resize(20 * heights.size());
  g.step = (g.slice_positions.back() - g.slice_positions.front()) / (g.dimensions.z - 1.0);
  volume.voxels = std::move(voxels);
  return volume;
}

/// By the definition: all slices within three standard deviations along the steps and not behind a gap, each weighted
/// by a Gaussian of its distance and by half of the way to its neighbors.
double gaussian_by_definition(const Volume& volume, const std::vector<double>& values, int k, double sigma) {
  const Geometry& g = volume.geometry;
  const int last = g.dimensions.z - 1;
  const auto apart = [&](int a, int b) {
    return glm::distance(g.slice_positions[static_cast<std::size_t>(a)],
                         g.slice_positions[static_cast<std::size_t>(b)]);
  };
  const auto is_cut_off = [&](int m) {
    return std::ranges::any_of(g.gaps, [&](int gap) { return gap >= std::min(k, m) && gap < std::max(k, m); });
  };
  double sum = 0, weights = 0;
  for (int m = 0; m <= last; ++m) {
    if (apart(k, m) > 3 * sigma || is_cut_off(m)) continue;
    const int before = std::max(m - 1, 0), after = std::min(m + 1, last);
    const double weight = apart(before, after) / (after - before) * std::exp(-0.5 * std::pow(apart(k, m) / sigma, 2));
    sum += weight * values[static_cast<std::size_t>(m)];
    weights += weight;
  }
  return sum / weights;
}

TEST(FilterReach, IsThreeDeviationsAlongTheStepsAndNoFartherThanAGap) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    const int count = 2 + static_cast<int>(random() % 40);
    std::vector<double> heights, values;
    double height = any(-50, 50);
    for (int k = 0; k < count; ++k) {
      heights.push_back(height += any(0.3, 1.5));
      values.push_back(any(-1000, 1000));
    }
    Volume volume = slices_of_values(heights, values, any(-0.5, 0.5));
    for (int k = 0; k + 1 < count; ++k) {
      if (random() % 12 == 0) volume.geometry.gaps.push_back(k);
    }
    const double sigma = any(0.2, 3);
    const auto smooth =
        filtered(std::make_shared<const Volume>(volume), {.type = find_filter_type("gaussian"), .sigma_mm = sigma});
    for (int k = 0; k < count; ++k) {
      const double expected = gaussian_by_definition(volume, values, k, sigma);
      for (const auto& [i, j] : {std::pair{0, 0}, {4, 3}, {2, 1}}) {
        ASSERT_NEAR(smooth->value_at(i, j, k), expected, 0.01) << seed << ", slice " << k;
      }
    }
  }
}

TEST(FilterReach, OfOneSliceAloneLeavesIt) {
  const Volume volume = slices_of_values({7}, {42}, 0);
  const auto smooth =
      filtered(std::make_shared<const Volume>(volume), {.type = find_filter_type("gaussian"), .sigma_mm = 2});
  for (int n = 0; n < 20; ++n) EXPECT_FLOAT_EQ(static_cast<float>(smooth->value_at(n % 5, n / 5, 0)), 42);
}

TEST(FilterReach, LeavesThePatientAsItWas) {
  Volume volume = slices_of_values({0, 1, 2}, {1, 2, 3}, 0);
  volume.patient_id = "4711";
  volume.patient_name = "Doe^Jane";
  const auto smooth =
      filtered(std::make_shared<const Volume>(volume), {.type = find_filter_type("median"), .width = 3});
  EXPECT_EQ(smooth->patient_id, "4711");
  EXPECT_EQ(smooth->patient_name, "Doe^Jane");
  EXPECT_EQ(smooth->slope, 1);
  EXPECT_EQ(smooth->intercept, 0);
  EXPECT_FALSE(smooth->padding);
}

}  // namespace
}  // namespace palpate::io
