// Statistics against independent sums: of integers up to the largest that fit, in more voxels than any block counted at
// once, with and without padding and with a slope of either sign.
#include "io/volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>

namespace palpate::io {
namespace {

template <typename Stored>
Volume volume_of(std::vector<Stored> voxels, double slope) {
  Volume volume;
  volume.geometry.dimensions = {static_cast<int>(voxels.size()), 1, 1};
  volume.voxels = std::move(voxels);
  volume.slope = slope;
  volume.intercept = -7;
  return volume;
}

/// As the definitions have it, voxel by voxel.
Statistics counted(const Volume& volume, bool with_padding) {
  Statistics all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0, 0};
  for (int i = 0; i < volume.geometry.dimensions.x; ++i) {
    if (!with_padding && volume.is_padding(i, 0, 0)) continue;
    const double value = volume.value_at(i, 0, 0);
    all.minimum = std::min(all.minimum, value);
    all.maximum = std::max(all.maximum, value);
    all.mean += value;
    ++all.count;
  }
  all.mean /= static_cast<double>(all.count);
  return all;
}

void expect_same(const Statistics& a, const Statistics& b) {
  EXPECT_EQ(a.count, b.count);
  EXPECT_DOUBLE_EQ(a.minimum, b.minimum);
  EXPECT_DOUBLE_EQ(a.maximum, b.maximum);
  EXPECT_NEAR(a.mean, b.mean, 1e-6 * (1 + std::abs(b.mean)));
}

/// The least and the largest values come last, each once, behind the last whole piece.
template <typename Stored>
std::vector<Stored> many_voxels() {
  constexpr std::size_t count = (std::size_t{1} << 20) + (std::size_t{1} << 15) + 7;
  std::vector<Stored> voxels(count);
  std::mt19937 random(1);
  for (Stored& v : voxels) v = static_cast<Stored>(20000 + static_cast<int>(random() % 12000U));
  if constexpr (std::is_integral_v<Stored>) {
    voxels[count - 2] = std::numeric_limits<Stored>::max();
    voxels[count - 1] = std::numeric_limits<Stored>::lowest();
  } else {
    voxels[count - 2] = 60000;
    voxels[count - 1] = -60000;
  }
  return voxels;
}

template <typename Stored>
void expect_of_many(double slope) {
  Volume volume = volume_of(many_voxels<Stored>(), slope);
  expect_same(statistics(volume), counted(volume, true));
  volume.padding = {21000, 22000};
  const Statistics without = counted(volume, false);
  expect_same(statistics_without_padding(volume), without);
  // Where voxels are floats, padding has no value of its own.
  expect_same(statistics(volume), std::is_integral_v<Stored> ? counted(volume, true) : without);
}

TEST(VolumeStatistics, AreThoseOfEveryVoxel) {
  expect_of_many<std::int16_t>(-0.5);
  expect_of_many<std::uint16_t>(2);
  expect_of_many<float>(-3);
}

TEST(VolumeStatistics, OfNothingAreZero) {
  Volume volume = volume_of(std::vector<std::int16_t>{5, 5}, 1);
  volume.padding = {5, 5};
  expect_same(merge(statistics_without_padding(volume), {}), {});
  EXPECT_EQ(statistics_without_padding(volume).mean, 0);
}

TEST(VolumeStatistics, OfTwoTogetherAreThoseOfAllTheirVoxels) {
  const std::vector<std::int16_t> a{3, -8, 100}, b{7, 7, 7, 7, 7, 21, -30};
  std::vector<std::int16_t> all = a;
  all.insert(all.end(), b.begin(), b.end());
  const Statistics one = statistics(volume_of(a, 3)), other = statistics(volume_of(b, 3));
  expect_same(merge(one, other), counted(volume_of(all, 3), true));
  expect_same(merge(other, one), counted(volume_of(all, 3), true));
  expect_same(merge(one, {}), one);
  expect_same(merge({}, one), one);
}

}  // namespace
}  // namespace palpate::io
