/// Recordings name a scan by its hash, also those of years ago: it is the XXH3 of these bytes in this order, whatever
/// this version makes it with.

#include <gtest/gtest.h>

#include "plugin/session/scan_hash.h"
#define XXH_INLINE_ALL  // xxHash's own code, not the library that the program uses
#include <xxhash.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace palpate::plugin {
namespace {

/// Bytes, one value after the other.
struct HashedBytes {
  std::string bytes;
  template <typename T>
  void add(const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::uint64_t hash() const { return XXH3_64bits(bytes.data(), bytes.size()); }
  std::string digits() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash()));
    return text;
  }
};

/// Of no bytes and of "abc", as `xxhsum -H3` prints them.
TEST(ScanHashBytes, AreHashedAsEverywhere) {
  HashedBytes bytes;
  EXPECT_EQ(bytes.digits(), "2d06800538d394c2");
  bytes.bytes = "abc";
  EXPECT_EQ(bytes.digits(), "78af5f94892f3950");
}

std::string hash_by_hand(const io::Volume& volume, const std::vector<std::uint64_t>& slices) {
  const io::Geometry& g = volume.geometry;
  HashedBytes bytes;
  for (const int size : {g.dimensions.x, g.dimensions.y, g.dimensions.z}) bytes.add(size);
  for (const glm::dvec3& v : {g.direction_i, g.direction_j}) {
    for (const double number : {v.x, v.y, v.z}) bytes.add(number);
  }
  bytes.add(g.spacing_i);
  bytes.add(g.spacing_j);
  bytes.add(std::uint64_t{g.slice_positions.size()});
  for (const glm::dvec3& v : g.slice_positions) {
    for (const double number : {v.x, v.y, v.z}) bytes.add(number);
  }
  bytes.add(std::uint64_t{g.gaps.size()});
  for (const int gap : g.gaps) bytes.add(gap);
  bytes.add(static_cast<unsigned char>(volume.padding ? 1 : 0));
  if (volume.padding) {
    const double one = volume.slope * volume.padding->first + volume.intercept;
    const double other = volume.slope * volume.padding->second + volume.intercept;
    bytes.add(std::min(one, other));
    bytes.add(std::max(one, other));
  }
  if (volume.vectors) {
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) bytes.add(volume.vectors->to_patient[column][row]);
    }
  }
  bytes.add(std::uint64_t{slices.size()});
  for (const std::uint64_t slice : slices) bytes.add(slice);
  return bytes.digits();
}

/// Every number another, of any of the three kinds of voxels.
io::Volume random_volume(std::mt19937_64& random) {
  std::uniform_real_distribution<double> number(-3, 3);
  io::Volume volume;
  io::Geometry& g = volume.geometry;
  const auto size = [&] { return static_cast<int>(1 + random() % 5); };
  g.dimensions = {size(), size(), size()};
  g.direction_i = {number(random), number(random), number(random)};
  g.direction_j = {number(random), number(random), number(random)};
  g.spacing_i = 4 + number(random);
  g.spacing_j = 4 + number(random);
  for (int k = 0; k < g.dimensions.z; ++k)
    g.slice_positions.emplace_back(number(random), number(random), number(random));
  for (auto gap = random() % 3; gap > 0; --gap) g.gaps.push_back(static_cast<int>(random() % 9));
  volume.slope = random() % 2 == 0 ? number(random) : 1;
  volume.intercept = random() % 2 == 0 ? number(random) : 0;
  if (random() % 2 == 0) volume.padding = {number(random), number(random)};
  const std::size_t count = volume.offset(0, 0, g.dimensions.z);
  const auto fill = [&](auto voxels) {
    voxels.resize(count);
    for (auto& voxel : voxels) voxel = static_cast<std::remove_reference_t<decltype(voxel)>>(random() % 4096) - 7;
    volume.voxels = voxels;
  };
  if (random() % 3 == 0) {
    fill(std::vector<std::int16_t>());
  } else if (random() % 2 == 0) {
    fill(std::vector<std::uint16_t>());
  } else {
    fill(std::vector<float>());
    std::get<std::vector<float>>(volume.voxels).front() = -0.0F;
  }
  return volume;
}

/// A slice's hash is that of its rescaled values as floats, in which a zero has no sign.
std::uint64_t slice_by_hand(const io::Volume& volume, int k) {
  HashedBytes bytes;
  for (int j = 0; j < volume.geometry.dimensions.y; ++j) {
    for (int i = 0; i < volume.geometry.dimensions.x; ++i) {
      const auto value = static_cast<float>(volume.value_at(i, j, k));
      bytes.add(value == 0 ? 0.0F : value);
    }
  }
  return bytes.hash();
}

TEST(ScanHashBytes, AreThoseOfTheLatticeAndOfEachSlice) {
  std::mt19937_64 random(6);
  for (int n = 0; n < 100; ++n) {
    io::Volume volume = random_volume(random);
    std::vector<std::uint64_t> slices;
    const auto add = [&](const io::Volume& of) {
      for (int k = 0; k < of.geometry.dimensions.z; ++k) {
        slices.push_back(slice_by_hand(of, k));
        ASSERT_EQ(hash_of_slice(of, k), slices.back());
      }
    };
    add(volume);
    if (n % 4 == 0) {
      io::VectorComponents vectors;
      for (auto& along : vectors.along) {
        along = std::make_shared<const io::Volume>(random_volume(random));
        add(*along);
      }
      vectors.to_patient = glm::dmat3({1, 2, 3}, {4, 5, 6}, {7, 8, 9.5});
      volume.vectors = std::make_shared<const io::VectorComponents>(vectors);
    }
    ASSERT_EQ(hashes_of_slices(volume), slices);
    ASSERT_EQ(hash_of(volume), hash_by_hand(volume, slices));
    ASSERT_EQ(hash_of(volume, slices), hash_by_hand(volume, slices));
    const std::string uid = "1.2.840." + std::to_string(random());
    ASSERT_EQ(hash_of_series(uid, volume), hash_by_hand(volume, {XXH3_64bits(uid.data(), uid.size())}));
  }
}

/// A value that becomes zero as a float has no sign either.
TEST(ScanHashBytes, AZeroHasOneSign) {
  io::Volume volume;
  volume.geometry.dimensions = {2, 1, 1};
  volume.geometry.slice_positions = {{0, 0, 0}};
  volume.voxels = std::vector<float>{1, -1};
  volume.slope = 1e-80;
  io::Volume zeros = volume;
  zeros.slope = 0;
  EXPECT_EQ(hash_of_slice(volume, 0), hash_of_slice(zeros, 0));
}

}  // namespace
}  // namespace palpate::plugin
