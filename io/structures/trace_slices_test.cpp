// Contours that are traced on a scan's slices, oblique and tilted ones among them. Truth: the areas of circles, and the
// lattice that label_image.h promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <mutex>
#include <numbers>
#include <vector>

#include "io/structures/label_image.h"
#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

std::vector<Geometry> traced_scans() {
  const glm::dmat3 turned(glm::rotate(glm::dmat4(1), glm::radians(33.0), glm::normalize(Vec3(1, 2, 3))));
  std::vector<Geometry> scans;
  for (const LabelLattice& lattice :
       {LabelLattice{.spacing = {1, 1.5, 2}}, LabelLattice{.spacing = {1.2, 1, 2}, .axes = turned},
        LabelLattice{.spacing = {1, 1.5, 2}, .axes = turned, .tilt_per_slice = 0.3}}) {
    scans.push_back(made_labels([](const Vec3&) { return false; }, 10, lattice).geometry);
  }
  return scans;
}

Vec3 normal_of(const Geometry& scan) {
  return glm::cross(scan.direction_i, scan.direction_j);
}

/// Positive if it runs counterclockwise around the slices' normal.
double area_on(const Geometry& scan, const std::vector<Vec3>& contour) {
  Vec3 sum(0);
  for (std::size_t n = 0; n + 1 < contour.size(); ++n) {
    sum += glm::cross(contour[n] - contour.front(), contour[n + 1] - contour.front());
  }
  return 0.5 * glm::dot(sum, normal_of(scan));
}

// Twice as fine as the voxels, from edge to edge of the outermost ones.
TEST(TraceSlices, AsksOnceAtEachNodeOfTheirLattice) {
  for (const Geometry& scan : traced_scans()) {
    std::mutex mutex;
    std::vector<std::array<int, 3>> asked;  // twice the index
    const auto distance = [&](const Vec3& at) {
      const Vec3 twice = 2.0 * scan.to_index(at);
      const std::lock_guard lock(mutex);
      asked.push_back({static_cast<int>(std::lround(twice.x)), static_cast<int>(std::lround(twice.y)),
                       static_cast<int>(std::lround(twice.z))});
      return 5 - glm::length(at);
    };
    trace_slices({}, scan, distance);
    std::vector<std::array<int, 3>> expected;
    for (int i = -1; i <= 2 * scan.dimensions.x - 1; ++i) {
      for (int j = -1; j <= 2 * scan.dimensions.y - 1; ++j) {
        for (int k = 0; k < scan.dimensions.z; ++k) expected.push_back({i, j, 2 * k});
      }
    }
    std::ranges::sort(asked);
    EXPECT_TRUE(asked == expected) << asked.size() << " of " << expected.size();
  }
}

TEST(TraceSlices, ABallIsCircles) {
  constexpr double radius = 7.3;
  for (const Geometry& scan : traced_scans()) {
    const SliceContours traced = trace_slices({}, scan, [](const Vec3& at) { return radius - glm::length(at); });
    EXPECT_EQ(traced.slices.size(), 8U);
    for (const SliceContours::Slice& slice : traced.slices) {
      ASSERT_EQ(slice.contours.size(), 1U) << slice.k;
      const double height = glm::dot(slice.contours[0][0], normal_of(scan));
      EXPECT_NEAR(height, 2 * slice.k - 9, 1e-9);
      for (const Vec3& point : slice.contours[0]) {
        EXPECT_NEAR(glm::length(point), radius, 0.05) << slice.k;
        EXPECT_NEAR(glm::dot(point, normal_of(scan)), height, 1e-9) << slice.k;
      }
      EXPECT_NEAR(area_on(scan, slice.contours[0]), std::numbers::pi * (radius * radius - height * height), 1.5);
    }
  }
}

TEST(TraceSlices, AHoleIsJoinedToTheContourAroundIt) {
  constexpr double radius = 7.3, hole = 4.1;
  for (const Geometry& scan : traced_scans()) {
    const SliceContours traced = trace_slices(
        {}, scan, [](const Vec3& at) { return std::min(radius - glm::length(at), glm::length(at) - hole); });
    EXPECT_EQ(traced.slices.size(), 8U);
    for (const SliceContours::Slice& slice : traced.slices) {
      ASSERT_EQ(slice.contours.size(), 1U) << slice.k;
      const double height = 2 * slice.k - 9, squared = height * height;
      EXPECT_NEAR(area_on(scan, slice.contours[0]),
                  std::numbers::pi * (radius * radius - squared - std::max(0.0, hole * hole - squared)), 2);
    }
  }
}

TEST(TraceSlices, AStructureEndsAtTheEdgesOfTheOutermostVoxels) {
  for (const Geometry& scan : traced_scans()) {
    const SliceContours traced = trace_slices({}, scan, [](const Vec3&) { return 100; });
    EXPECT_EQ(traced.slices.size(), static_cast<std::size_t>(scan.dimensions.z));
    for (const SliceContours::Slice& slice : traced.slices) {
      ASSERT_EQ(slice.contours.size(), 1U) << slice.k;
      EXPECT_NEAR(area_on(scan, slice.contours[0]),
                  scan.dimensions.x * scan.spacing_i * scan.dimensions.y * scan.spacing_j, 1e-3);
    }
  }
}

}  // namespace
}  // namespace palpate::io
