#include "plugin/session/scan_hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "io/rescaled.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

io::Volume ball(glm::dvec3 spacing = glm::dvec3(1)) {
  return testdata::scan(testdata::make_sphere(6),
                        testdata::make_geometry({.size = glm::ivec3(18, 16, 14), .spacing = spacing}));
}

/// The slices from `first` on as a volume of their own, as a server reads a few at a time.
io::Volume slices_of(const io::Volume& whole, int first, int count) {
  io::Volume part = whole;
  part.geometry.dimensions.z = count;
  auto& voxels = std::get<std::vector<std::int16_t>>(part.voxels);
  const auto begin = voxels.begin() + static_cast<std::ptrdiff_t>(whole.offset(0, 0, first));
  voxels = std::vector<std::int16_t>(begin, begin + static_cast<std::ptrdiff_t>(whole.offset(0, 0, count)));
  return part;
}

TEST(ScanHash, IsTheSameHoweverTheValuesAreStored) {
  io::Volume stored = ball();
  stored.padding = {-2000, -1900};
  ASSERT_NE(stored.intercept, 0);
  const io::Volume rescaled = io::rescaled(stored);
  ASSERT_EQ(rescaled.intercept, 0);
  io::Volume floats = rescaled;
  const auto& shorts = std::get<std::vector<std::int16_t>>(rescaled.voxels);
  floats.voxels = std::vector<float>(shorts.begin(), shorts.end());
  EXPECT_EQ(hash_of(stored).size(), 16U);
  EXPECT_EQ(hash_of(rescaled), hash_of(stored));
  EXPECT_EQ(hash_of(floats), hash_of(stored));
}

TEST(ScanHash, CanBeHadOfAFewSlicesAtATime) {
  const io::Volume whole = ball();
  std::vector<std::uint64_t> slices;
  for (int k = 0; k < whole.geometry.dimensions.z; k += 4) {
    const auto more = hashes_of_slices(slices_of(whole, k, std::min(4, whole.geometry.dimensions.z - k)));
    slices.insert(slices.end(), more.begin(), more.end());
  }
  io::Volume head = whole;
  head.voxels = {};
  EXPECT_EQ(hash_of(head, slices), hash_of(whole));
}

TEST(ScanHash, TellsEveryDifferenceThatIsFelt) {
  const io::Volume volume = ball();
  const std::string hash = hash_of(volume);
  io::Volume other = volume;
  ++std::get<std::vector<std::int16_t>>(other.voxels)[1234];
  EXPECT_NE(hash_of(other), hash) << "a voxel";
  other = volume;
  other.geometry.slice_positions.back().z += 1e-6;
  EXPECT_NE(hash_of(other), hash) << "a slice's place";
  other = volume;
  other.geometry.gaps = {3};
  EXPECT_NE(hash_of(other), hash) << "a gap";
  other = volume;
  other.padding = {-2000, -2000};
  EXPECT_NE(hash_of(other), hash) << "padding";
  EXPECT_NE(hash_of(ball({1, 1, 1.5})), hash) << "spacing";
  // Two slices in each other's place.
  other = volume;
  auto& voxels = std::get<std::vector<std::int16_t>>(other.voxels);
  std::swap_ranges(voxels.begin() + static_cast<std::ptrdiff_t>(other.offset(0, 0, 2)),
                   voxels.begin() + static_cast<std::ptrdiff_t>(other.offset(0, 0, 3)),
                   voxels.begin() + static_cast<std::ptrdiff_t>(other.offset(0, 0, 5)));
  EXPECT_NE(hash_of(other), hash) << "the order of slices";
}

/// No two of these scans are felt alike.
TEST(ScanHash, CountsEachNumberOfTheLatticeAndThePadding) {
  io::Volume scan = ball();
  scan.padding = {-2000, -1900};
  std::vector<io::Volume> scans(8, scan);
  scans[1].padding->first = -2001;
  scans[2].padding->second = -1899;
  scans[3].padding.reset();
  scans[4].geometry.direction_i = {0, 0, 1};
  scans[5].geometry.direction_j = {0, 0, 1};
  scans[6].geometry.spacing_i = 1.25;
  scans[7].geometry.spacing_j = 1.25;
  std::set<std::string> hashes;
  for (const io::Volume& one : scans) hashes.insert(hash_of(one));
  EXPECT_EQ(hashes.size(), scans.size());
}

TEST(ScanHash, HasTheVectorsOfAVelocityField) {
  const auto component = std::make_shared<const io::Volume>(ball());
  io::Volume field = ball();
  field.vectors = std::make_shared<const io::VectorComponents>(
      io::VectorComponents{.along = {component, component, component}, .to_patient = glm::dmat3(1)});
  const std::string hash = hash_of(field);
  EXPECT_NE(hash, hash_of(ball()));
  field.vectors = std::make_shared<const io::VectorComponents>(
      io::VectorComponents{.along = {component, component, component}, .to_patient = glm::dmat3(-1)});
  EXPECT_NE(hash_of(field), hash);
}

}  // namespace
}  // namespace palpate::plugin
