// The voxels of a scan that are looked at for a structure that has a box.
#include "io/structures/label_image.h"

#include <gtest/gtest.h>

#include <atomic>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <random>
#include <vector>

#include "io/structures/grid_box.h"
#include "io/testing/formula_boundary.h"

namespace palpate::io {
namespace {

/// Oblique and tilted, with voxels of any shape.
Geometry any_scan(unsigned seed) {
  Geometry scan = testing::tilted_boundary(seed).geometry;
  scan.dimensions = {7, 6, 5};
  scan.slice_positions.resize(5);
  return scan;
}

/// Within the scan, across its faces or wholly beside it.
StructureBox any_box(const Geometry& scan, std::mt19937& random) {
  std::uniform_real_distribution<double> share(-0.4, 1.4), half_mm(0, 4);
  const double i = share(random), j = share(random), k = share(random);
  const Vec3 middle = scan.to_patient(Vec3(i, j, k) * Vec3(scan.dimensions - 1));
  const double x = half_mm(random), y = half_mm(random), z = half_mm(random);
  return {.low_mm = middle - Vec3(x, y, z), .high_mm = middle + Vec3(x, y, z)};
}

/// Every voxel of the scan in turn.
template <typename Work>
void for_each_voxel(const Geometry& scan, const Work& work) {
  for (int k = 0; k < scan.dimensions.z; ++k) {
    for (int j = 0; j < scan.dimensions.y; ++j) {
      for (int i = 0; i < scan.dimensions.x; ++i) work(glm::ivec3(i, j, k));
    }
  }
}

bool lies_in(const StructureBox& box, const Vec3& at) {
  return glm::all(glm::greaterThanEqual(at, box.low_mm)) && glm::all(glm::lessThanEqual(at, box.high_mm));
}

TEST(LabelImage, ItsBoxHasAVoxelMoreOnEachSideAndEndsWithTheScan) {
  Geometry scan;
  scan.dimensions = {10, 8, 6};
  for (int k = 0; k < 6; ++k) scan.slice_positions.emplace_back(0, 0, k);
  struct Case {
    Vec3 low_mm, high_mm;
    glm::ivec3 low, high;
  };
  for (const auto& [low_mm, high_mm, low, high] : std::vector<Case>{
           {{3.2, 3.2, 2.2}, {4.7, 4.7, 2.7}, {2, 2, 1}, {6, 6, 4}},
           {{3, 3, 2}, {5, 5, 3}, {2, 2, 1}, {6, 6, 4}},
           {{0, 0, 0}, {9, 7, 5}, {0, 0, 0}, {9, 7, 5}},
           {{-50, 2, -0.5}, {2.5, 70, 5.5}, {0, 1, 0}, {4, 7, 5}},
           {{-50, -60, -70}, {50, 60, 70}, {0, 0, 0}, {9, 7, 5}},
           {{20, 30, 40}, {50, 60, 70}, {9, 7, 5}, {9, 7, 5}},
           {{-50, -60, -70}, {-20, -30, -40}, {0, 0, 0}, {0, 0, 0}},
       }) {
    const IndexBox box = index_box(scan, StructureBox{low_mm, high_mm});
    EXPECT_EQ(box.low, low) << low_mm.x;
    EXPECT_EQ(box.high, high) << low_mm.x;
  }
  EXPECT_EQ(index_box(scan, {}).low, glm::ivec3(0));
  EXPECT_EQ(index_box(scan, {}).high, glm::ivec3(9, 7, 5));
}

TEST(LabelImage, ItsBoxHoldsEveryVoxelOfTheStructuresBoxAndThoseBeside) {
  std::mt19937 random(3);
  int held = 0, across = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Geometry scan = any_scan(seed);
    const StructureBox within = any_box(scan, random);
    const IndexBox box = index_box(scan, within);
    const glm::ivec3 last = scan.dimensions - 1;
    ASSERT_TRUE(glm::all(glm::greaterThanEqual(box.low, glm::ivec3(0)))) << seed;
    ASSERT_TRUE(glm::all(glm::lessThanEqual(box.low, box.high))) << seed;
    ASSERT_TRUE(glm::all(glm::lessThanEqual(box.high, last))) << seed;
    across += glm::any(glm::equal(box.high, last)) ? 1 : 0;
    for_each_voxel(scan, [&](const glm::ivec3& voxel) {
      if (!lies_in(within, scan.to_patient(Vec3(voxel)))) return;
      ++held;
      EXPECT_TRUE(glm::all(glm::lessThanEqual(box.low, glm::max(voxel - 1, glm::ivec3(0))))) << seed;
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(box.high, glm::min(voxel + 1, last)))) << seed;
    });
  }
  EXPECT_GT(held, 50);
  EXPECT_GT(across, 50);
}

// What lies beyond the box is outside without being asked.
TEST(LabelImage, VoxelsBeyondTheBoxAreNotAskedFor) {
  std::mt19937 random(4);
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Geometry scan = any_scan(seed);
    const StructureBox within = any_box(scan, random);
    const IndexBox box = index_box(scan, within);
    std::atomic<int> asked{0};
    const auto everywhere = [&](const Vec3&) {
      ++asked;
      return 1.0;
    };
    const LabelImage image = sample_labels({}, scan, everywhere, within);
    ASSERT_EQ(image.inside.size(), 7U * 6U * 5U);
    int inside = 0;
    for_each_voxel(scan, [&](const glm::ivec3& voxel) {
      const bool in = glm::all(glm::lessThanEqual(box.low, voxel)) && glm::all(glm::lessThanEqual(voxel, box.high));
      EXPECT_EQ(image.inside[image.offset(voxel.x, voxel.y, voxel.z)], in ? 1 : 0) << seed;
      inside += in ? 1 : 0;
    });
    EXPECT_EQ(asked, inside) << seed;
  }
}

}  // namespace
}  // namespace palpate::io
