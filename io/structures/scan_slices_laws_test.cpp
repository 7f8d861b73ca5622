// The slices of a scan that a mask takes, however the rows and columns of either lie.
#include "io/structures/scan_slices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

namespace palpate::io {
namespace {

/// The eight ways in which rows and columns may lie along the same two axes; half of them look from below.
struct RowsAndColumns {
  Vec3 i, j;
};
std::vector<RowsAndColumns> ways_of(const Vec3& x, const Vec3& y) {
  return {{x, y}, {x, -y}, {-x, y}, {-x, -y}, {y, x}, {y, -x}, {-y, x}, {-y, -x}};
}

/// Slices at those heights, each moved aside by the tilt; ascending along the way's normal.
Geometry slices_at(const RowsAndColumns& way, std::vector<double> heights, const Vec3& up, const Vec3& tilt) {
  Geometry geometry;
  geometry.dimensions = {4, 3, static_cast<int>(heights.size())};
  geometry.direction_i = way.i;
  geometry.direction_j = way.j;
  if (glm::dot(glm::cross(way.i, way.j), up) < 0) std::ranges::reverse(heights);
  for (const double height : heights) geometry.slice_positions.push_back(height * (up + tilt));
  if (heights.size() > 1) {
    geometry.step = (geometry.slice_positions.back() - geometry.slice_positions.front()) /
                    (static_cast<double>(heights.size()) - 1);
  }
  return geometry;
}

/// A scan with steps of all lengths, and a mask of some of its slices: each holds its number in the scan, from 1.
struct SlicesCase {
  Vec3 up, tilt;
  std::vector<double> heights;   // of the scan
  std::vector<std::size_t> own;  // slices of the mask
  Geometry scan;
  Mask mask;
};

class SlicesCases {
 public:
  /// `moved_mm`: of one of the mask's slices.
  SlicesCase next(const std::vector<bool>& has, double moved_mm = 0) {
    SlicesCase made;
    made.up = unit();
    const Vec3 x = glm::normalize(glm::cross(made.up, unit())), y = glm::cross(made.up, x);
    made.tilt = 0.3 * part(random_) * y;
    for (std::size_t n = 0; n < has.size(); ++n) {
      made.heights.push_back((n == 0 ? -20 : made.heights.back()) + 1 + 2 * part(random_));
      if (has[n]) made.own.push_back(n);
    }
    std::vector<double> heights;
    for (const std::size_t n : made.own) heights.push_back(made.heights[n]);
    heights[heights.size() / 2] += moved_mm;
    const std::vector<RowsAndColumns> ways = ways_of(x, y);
    std::uniform_int_distribution<std::size_t> any(0, ways.size() - 1);
    const RowsAndColumns of_scan = ways[any(random_)], of_mask = ways[any(random_)];
    made.scan = slices_at(of_scan, made.heights, made.up, made.tilt);
    made.mask.geometry = slices_at(of_mask, heights, made.up, made.tilt);
    made.mask.low = {1, 1, 0};
    made.mask.size = {2, 1, static_cast<int>(made.own.size())};
    const bool is_from_above = glm::dot(glm::cross(of_mask.i, of_mask.j), made.up) > 0;
    for (std::size_t k = 0; k < made.own.size(); ++k) {
      const std::size_t n = made.own[is_from_above ? k : made.own.size() - 1 - k];
      made.mask.occupancy.insert(made.mask.occupancy.end(), 2, static_cast<std::uint8_t>(n + 1));
    }
    return made;
  }
  double part() { return part(random_); }
  bool any() { return random_() % 2 == 0; }

 private:
  static double part(std::mt19937_64& random) { return std::uniform_real_distribution<double>(0, 1)(random); }
  Vec3 unit() {
    std::normal_distribution<double> along;
    const double x = along(random_), y = along(random_), z = along(random_);
    return glm::normalize(Vec3(x, y, z));
  }
  std::mt19937_64 random_{21};
};

TEST(ScanSlices, AMaskHasThoseOfTheScanFromBelowItToAboveIt) {
  SlicesCases cases;
  for (int n = 0; n < 200; ++n) {
    std::vector<bool> has(12, false);
    for (std::size_t slice = 2; slice < 10; ++slice) has[slice] = cases.any();
    has[5] = has[6] = true;  // neighbors: it is as fine as the scan
    SlicesCase made = cases.next(has);
    const double around_mm = 6 * cases.part();
    take_slices_of(made.scan, around_mm, made.mask);
    std::vector<double> expected, found;
    for (const double height : made.heights) {
      const bool is_near =
          height >= made.heights[made.own.front()] - around_mm && height <= made.heights[made.own.back()] + around_mm;
      if (is_near) expected.push_back(height);
    }
    const Geometry& geometry = made.mask.geometry;
    ASSERT_EQ(geometry.slice_positions.size(), expected.size()) << n;
    EXPECT_EQ(geometry.dimensions.z, static_cast<int>(expected.size()));
    const Vec3 normal = glm::cross(geometry.direction_i, geometry.direction_j);
    EXPECT_GT(glm::dot(geometry.step, normal), 0);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const Vec3& at = geometry.slice_positions[k];
      found.push_back(glm::dot(at, made.up));
      EXPECT_LT(glm::distance(at, found.back() * (made.up + made.tilt)), 1e-9) << "it slides along as the mask does";
      if (k == 0) continue;
      EXPECT_GT(glm::dot(at - geometry.slice_positions[k - 1], normal), 0);
    }
    std::ranges::sort(found);
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-9) << n;
    // Each slice holds what it held, and one that the mask did not have is empty.
    for (int k = 0; k < made.mask.size.z; ++k) {
      const Vec3& at = geometry.slice_positions[static_cast<std::size_t>(made.mask.low.z + k)];
      const int held = made.mask.occupancy[made.mask.offset(1, 0, k)];
      std::size_t of_scan = 0;
      while (std::abs(made.heights[of_scan] - glm::dot(at, made.up)) > 1e-9) ++of_scan;
      EXPECT_EQ(held, has[of_scan] ? static_cast<int>(of_scan) + 1 : 0) << n << ", " << k;
    }
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(made.mask.occupancy, 0)),
              2 * (static_cast<std::size_t>(made.mask.size.z) - made.own.size()));
  }
}

/// One that lies between the scan's slices, or along other planes, or has only every second of them stays as it is.
TEST(ScanSlices, AMaskThatHasOthersKeepsItsOwn) {
  SlicesCases cases;
  for (int n = 0; n < 200; ++n) {
    std::vector<bool> has(12, false);
    for (std::size_t slice = 2; slice < 10; ++slice) has[slice] = n % 3 != 0 || slice % 2 == 0;
    SlicesCase made = cases.next(has, n % 3 == 1 ? 0.3 + 0.2 * cases.part() : 0);
    if (n % 3 == 2) {
      const Vec3 i = made.scan.direction_i;
      made.scan.direction_i = glm::normalize(i + 0.1 * made.up);
      made.scan.direction_j =
          glm::normalize(glm::cross(glm::cross(made.scan.direction_i, made.scan.direction_j), made.scan.direction_i));
    }
    const Mask before = made.mask;
    take_slices_of(made.scan, 5, made.mask);
    EXPECT_EQ(made.mask.geometry.slice_positions, before.geometry.slice_positions) << n;
    EXPECT_EQ(made.mask.geometry.dimensions, before.geometry.dimensions) << n;
    EXPECT_EQ(made.mask.occupancy, before.occupancy) << n;
    EXPECT_EQ(made.mask.low, before.low) << n;
  }
}

}  // namespace
}  // namespace palpate::io
