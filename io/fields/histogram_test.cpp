#include "io/fields/histogram.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>
#include <mutex>
#include <numeric>
#include <span>
#include <stdexcept>

#include "io/fields/evenly_spread.h"
#include "io/fields/low_high.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

const Bins values{-1100, 1100, 44};
const Bins magnitudes{0, 300, 30};

std::shared_ptr<const Volume> sphere(double circle) {
  testdata::Grid grid;
  grid.size = {50, 46, 40};
  return std::make_shared<const Volume>(
      testdata::scan(testdata::make_sphere(12), testdata::make_geometry(grid), {.circle_radius = circle}));
}

TEST(JointHistogram, CountsEachVoxelOfTheWholeGradientOnce) {
  const auto volume = sphere(21);
  const GradientKernel kernel(volume, 2);
  const JointHistogram histogram = joint_histogram(*volume, kernel, values, magnitudes);
  const auto gradients = kernel.whole();
  std::vector<std::uint64_t> counts(std::size_t{44} * 30);
  std::uint64_t voxels = 0;
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 46; ++j) {
      for (int i = 0; i < 50; ++i) {
        if (volume->is_padding(i, j, k)) continue;
        const auto magnitude = static_cast<double>(glm::length(gradients[volume->offset(i, j, k)]));
        ++counts[static_cast<std::size_t>(magnitude / 10) * 44 +
                 static_cast<std::size_t>((volume->value_at(i, j, k) + 1100) / 50)];
        ++voxels;
      }
    }
  }
  EXPECT_EQ(histogram.counts, counts);
  EXPECT_EQ(histogram.voxels, voxels);
  EXPECT_LT(voxels, 50U * 46 * 40);
  EXPECT_EQ(joint_histogram(*volume, kernel, values, magnitudes, {}, 1).counts, counts);
}

TEST(JointHistogram, OfASphereIsTwoTissuesAndAnArch) {
  const auto volume = sphere(0);
  const GradientKernel kernel(volume, 2);
  const JointHistogram h = joint_histogram(*volume, kernel, values, magnitudes);
  EXPECT_GT(h.at(values.bin_of(-1000), 0), h.voxels / 2);
  EXPECT_GT(h.at(values.bin_of(40), 0), 1000U);
  // The steepest voxels, 1040 HU / (2 mm sqrt(2 pi)) = 207 HU/mm, have values between the two.
  std::uint64_t between = 0;
  for (int v = values.bin_of(-900); v <= values.bin_of(-60); ++v) {
    for (int m = magnitudes.bin_of(150); m < magnitudes.count; ++m) between += h.at(v, m);
  }
  EXPECT_GT(between, 500U);
  for (int m = magnitudes.bin_of(230); m < magnitudes.count; ++m) {
    for (int v = 0; v < values.count; ++v) EXPECT_EQ(h.at(v, m), 0U);
  }
}

/// Of each voxel whose gradient is steeper than a threshold: a column of its thinner side, a row of its denser one.
TEST(LowHighHistogram, CountsEachEdgeByItsTwoSides) {
  testdata::Grid grid;
  grid.size = {40, 36, 30};
  const auto volume = std::make_shared<const Volume>(
      testdata::scan(testdata::make_sphere(9), testdata::make_geometry(grid), {.circle_radius = 10}));
  const GradientKernel kernel(volume, 2);
  const auto gradients = kernel.whole();
  constexpr std::array<double, 3> least{60, 20, 150};
  std::array<std::vector<std::uint64_t>, 3> counts;
  counts.fill(std::vector<std::uint64_t>(std::size_t{44} * 44));
  for (int k = 0; k < 30; ++k) {
    for (int j = 0; j < 36; ++j) {
      for (int i = 0; i < 40; ++i) {
        const glm::vec3 gradient = gradients[volume->offset(i, j, k)];
        if (volume->is_padding(i, j, k)) continue;
        for (std::size_t h = 0; h < least.size(); ++h) {
          if (!(static_cast<double>(glm::length(gradient)) > least[h])) continue;
          const LowHigh sides = low_high_at(*volume, {i, j, k}, Vec3(gradient), 2);
          const auto column = static_cast<std::size_t>((static_cast<double>(sides.low) + 1100) / 50);
          const auto row = static_cast<std::size_t>((static_cast<double>(sides.high) + 1100) / 50);
          ++counts[h][row * 44 + column];
        }
      }
    }
  }
  std::mutex adding;
  std::vector<std::uint64_t> used(std::size_t{44} * 44);
  const auto use = [&](std::span<const CountedEdge> edges) {
    const std::scoped_lock lock(adding);
    for (const CountedEdge& edge : edges) {
      ++used[static_cast<std::size_t>(edge.high) * 44 + static_cast<std::size_t>(edge.low)];
      EXPECT_EQ(edge.gradient, gradients[volume->offset(edge.voxel.x, edge.voxel.y, edge.voxel.z)]);
    }
  };
  const std::vector<LowHighHistogram> found = low_high_histograms(*volume, kernel, values, least, {}, 0, use);
  ASSERT_EQ(found.size(), least.size());
  EXPECT_EQ(used, counts[0]) << "those above the first of the least magnitudes are used, though it is not the least";
  for (std::size_t h = 0; h < least.size(); ++h) {
    EXPECT_EQ(found[h].counts, counts[h]) << least[h];
    EXPECT_EQ(found[h].voxels, std::accumulate(counts[h].begin(), counts[h].end(), std::uint64_t{0})) << least[h];
    EXPECT_GT(found[h].voxels, 100U);
    EXPECT_EQ(low_high_histogram(*volume, kernel, values, least[h], {}, 1).counts, counts[h]);
  }
  EXPECT_LT(found[2].voxels, found[0].voxels);
  EXPECT_LT(found[0].voxels, found[1].voxels);
}

TEST(JointHistogram, RefusesBinsThatAreNone) {
  const auto volume = sphere(0);
  const GradientKernel kernel(volume, 2);
  EXPECT_THROW(joint_histogram(*volume, kernel, {0, 0, 4}, magnitudes), std::logic_error);
  EXPECT_THROW(joint_histogram(*volume, kernel, values, {0, 1, 0}), std::logic_error);
}

TEST(Bins, CountWhatLiesOutsideInTheOutermost) {
  EXPECT_EQ(values.bin_of(-5000), 0);
  EXPECT_EQ(values.bin_of(5000), 43);
  EXPECT_EQ(values.bin_of(1100), 43);
  for (int bin = 0; bin < values.count; ++bin) EXPECT_EQ(values.bin_of(values.middle(bin)), bin);
}

TEST(EvenlySpread, HasTheVoxelsWhoseHashTheStrideDivides) {
  for (const std::uint64_t all : {10U, 1000U, 65'000U, 1'000'000U, 4'000'000U, 4'294'967'295U}) {
    constexpr std::uint64_t enough = 1000;
    const internal::EvenlySpread spread(all, enough);
    for (std::uint64_t offset = 0; offset < 100'000; ++offset) {
      const std::uint64_t hash = (offset * 0x9E3779B97F4A7C15U) >> 32U;
      ASSERT_EQ(spread.has(offset), hash % (1 + all / enough) == 0) << all << " voxels, " << offset;
    }
  }
}

}  // namespace
}  // namespace palpate::io
