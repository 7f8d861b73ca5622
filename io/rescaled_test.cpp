/// Rescaled values are the stored ones, in as few bits as hold them.

#include "io/rescaled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <variant>
#include <vector>

namespace palpate::io {
namespace {

Volume stored(Volume::Voxels voxels, double slope, double intercept, const glm::ivec3& size) {
  Volume volume;
  volume.geometry.dimensions = size;
  for (int k = 0; k < size.z; ++k) volume.geometry.slice_positions.emplace_back(0, 0, k);
  volume.voxels = std::move(voxels);
  volume.slope = slope;
  volume.intercept = intercept;
  return volume;
}

/// Whole numbers stay whole where 16 bits hold them, and every value is the one that it was.
TEST(Rescaled, AreTheStoredOnesRescaled) {
  struct Case {
    double slope, intercept;
    std::int16_t low, high;
    bool is_whole;
  };
  for (const Case& c :
       {Case{2, -1024, -5, 3000, true}, Case{-2, 100, -5, 3000, true}, Case{1, 0.5, -5, 3000, false},
        Case{0.5, 0, -5, 3000, false}, Case{1, 32767 - 3000, -5, 3000, true}, Case{1, 32768 - 3000, -5, 3000, false},
        Case{1, -32768 + 5, -5, 3000, true}, Case{1, -32769 + 5, -5, 3000, false},
        Case{-1, -32768 + 3000, -5, 3000, true}, Case{-1, -32769 + 3000, -5, 3000, false}}) {
    std::vector<std::int16_t> voxels{c.low, 7, c.high, 11, -1, 40, 99, 1000};
    Volume before = stored(voxels, c.slope, c.intercept, {2, 2, 2});
    before.padding = {-4, 30};
    const Volume after = rescaled(before);
    EXPECT_EQ(after.slope, 1);
    EXPECT_EQ(after.intercept, 0);
    EXPECT_EQ(std::holds_alternative<std::vector<std::int16_t>>(after.voxels), c.is_whole) << c.slope << c.intercept;
    for (int n = 0; n < 8; ++n) {
      const double wanted = c.slope * voxels[static_cast<std::size_t>(n)] + c.intercept;
      EXPECT_EQ(after.value_at(n % 2, n / 2 % 2, n / 4), wanted) << c.slope << " " << c.intercept;
      EXPECT_EQ(before.value_at(n % 2, n / 2 % 2, n / 4), wanted);
    }
    ASSERT_TRUE(after.padding);
    const double first = c.slope * -4 + c.intercept, last = c.slope * 30 + c.intercept;
    EXPECT_EQ(after.padding->first, std::min(first, last));
    EXPECT_EQ(after.padding->second, std::max(first, last));
  }
}

/// No voxel at all is no value that does not fit, and zeros of either kind stay.
TEST(Rescaled, OfNoVoxelsAreNone) {
  const Volume none = rescaled(stored(std::vector<std::uint16_t>(), 2, 1, {0, 0, 0}));
  EXPECT_EQ(none.slope, 1);
  EXPECT_EQ(none.intercept, 0);
  EXPECT_FALSE(none.padding);
}

/// The same of words without a sign, and of floats, which stay floats.
TEST(Rescaled, OfEveryKindOfVoxelAreTheStoredOnesRescaled) {
  std::mt19937 random(4);
  for (const auto& [slope, intercept] : {std::pair{1.0, -1024.0}, {3.0, 0.0}, {-2.0, 7.0}, {0.25, -0.5}, {1.0, 0.0}}) {
    std::vector<std::uint16_t> words(60);
    std::vector<float> floats(60);
    for (std::size_t n = 0; n < words.size(); ++n) {
      words[n] = static_cast<std::uint16_t>(random() % 10000);
      floats[n] = static_cast<float>(words[n]) / 8;
    }
    const Volume of_words = rescaled(stored(words, slope, intercept, {5, 4, 3}));
    const Volume of_floats = rescaled(stored(floats, slope, intercept, {5, 4, 3}));
    for (std::size_t n = 0; n < words.size(); ++n) {
      const int i = static_cast<int>(n) % 5, j = static_cast<int>(n) / 5 % 4, k = static_cast<int>(n) / 20;
      ASSERT_EQ(of_words.value_at(i, j, k), slope * words[n] + intercept);
      ASSERT_EQ(of_floats.value_at(i, j, k), slope * static_cast<double>(floats[n]) + intercept);
    }
    EXPECT_TRUE(std::holds_alternative<std::vector<float>>(of_floats.voxels));
    const bool is_whole = slope == std::floor(slope) && intercept == std::floor(intercept);
    EXPECT_EQ(std::holds_alternative<std::vector<float>>(of_words.voxels), !is_whole);
  }
}

}  // namespace
}  // namespace palpate::io
