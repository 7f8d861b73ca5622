// Balls and shells, with distances, volumes and areas known by formulas. plugin/cli/command_compare_structures_test.cpp
// checks with other programs.

#include "io/structures/compare_outlines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "io/errors.h"
#include "io/structures/surface_points.h"

namespace palpate::io {
namespace {

const Vec3 middle(12.3, -45.6, 78.9);
const Vec3 oblique = glm::normalize(Vec3(0.6, -0.5, 0.7));

ComparedOutline outline(const SignedDistance& distance, const Vec3& center, double radius) {
  return {.distance = distance, .box = {center - radius, center + radius}};
}
ComparedOutline ball(const Vec3& center, double radius) {
  return outline([=](const Vec3& at) { return radius - glm::length(at - center); }, center, radius);
}
ComparedOutline shell(const Vec3& center, double outer, double inner) {
  return outline(
      [=](const Vec3& at) {
        const double r = glm::length(at - center);
        return std::min(outer - r, r - inner);
      },
      center, outer);
}

/// As near as so many lattice lines can tell: fewer on a small ball.
TEST(SurfacePoints, StandForTheSurfacesArea) {
  for (const double radius : {2.0, 7.5, 20.0}) {
    for (const double spacing : {0.1, 0.3, 0.5, 1.0}) {
      if (spacing > radius / 4 || spacing < radius / 80) continue;
      const ComparedOutline one = ball(middle, radius);
      double area = 0;
      Vec3 moment(0);
      for (const SurfacePoint& point : surface_points(one.distance, one.box, spacing)) {
        area += point.area_mm2;
        moment += point.area_mm2 * (point.at_mm - middle);
        EXPECT_NEAR(glm::length(point.at_mm - middle), radius, 0.003 * spacing * spacing / radius + 1e-3);
      }
      const double truth = 4 * std::numbers::pi * radius * radius;
      EXPECT_NEAR(area, truth, 0.45 * truth * spacing / radius) << radius << ' ' << spacing;
      EXPECT_LT(glm::length(moment) / area, 0.15 * spacing);
    }
  }
}

/// A box that is too small, and one that lies aside, grow.
TEST(SurfacePoints, AreFoundBeyondTheBox) {
  const ComparedOutline one = ball(middle, 10);
  const double truth = 4 * std::numbers::pi * 100;
  for (const StructureBox& box : {StructureBox{middle - 4.0, middle + 4.0}, StructureBox{middle - 10.0, middle}}) {
    double area = 0;
    for (const SurfacePoint& point : surface_points(one.distance, box, 0.5)) area += point.area_mm2;
    EXPECT_NEAR(area, truth, 0.02 * truth);
  }
}

TEST(CompareOutlines, OfTheSameOneIsNoDistance) {
  const OutlineComparison same = compare_outlines(ball(middle, 9), ball(middle, 9));
  EXPECT_DOUBLE_EQ(same.dice, 1);
  EXPECT_LT(same.largest_mm, 1e-3);
}

/// All of each sphere is as far from the other one: the radii's difference, near and far.
TEST(CompareOutlines, OfNestedBallsIsTheDifferenceOfTheirRadii) {
  for (const double larger : {8.5, 11.0, 20.0}) {
    const OutlineComparison found = compare_outlines(ball(middle, 8), ball(middle, larger));
    EXPECT_NEAR(found.mean_mm, larger - 8, 0.005) << larger;
    EXPECT_NEAR(found.p95_mm, larger - 8, 0.01);
    EXPECT_NEAR(found.largest_mm, larger - 8, 0.01);
    const double small = 512, large = larger * larger * larger;
    EXPECT_NEAR(found.dice, 2 * small / (small + large), 0.001);
  }
}

/// From a point on a sphere at the angle t from the way to the other one: | |x - c| - r |, whose mean and 95 % are
/// integrated here over cos t. What they share is a lens.
TEST(CompareOutlines, OfShiftedBallsIsWhatTheFormulasSay) {
  constexpr double r = 10;
  for (const double shift : {0.5, 3.0, 9.0, 26.0}) {
    SCOPED_TRACE(shift);
    const OutlineComparison found = compare_outlines(ball(middle, r), ball(middle + shift * oblique, r));
    std::vector<double> all;
    constexpr int steps = 200'000;
    double mean = 0;
    for (int n = 0; n < steps; ++n) {
      const double cosine = -1 + (2 * n + 1.0) / steps;
      all.push_back(std::abs(std::sqrt(r * r + shift * shift - 2 * r * shift * cosine) - r));
      mean += all.back() / steps;
    }
    std::ranges::sort(all);
    EXPECT_NEAR(found.mean_mm, mean, 0.005 + 0.002 * mean);
    EXPECT_NEAR(found.p95_mm, all[static_cast<std::size_t>(0.95 * steps)], 0.02);
    EXPECT_NEAR(found.largest_mm, shift, 0.02);
    const double off_axis = glm::length(glm::cross(found.largest_at_mm - middle, oblique));
    EXPECT_LT(off_axis, 2) << "at one of the two far ends";
    const double lens = shift < 2 * r ? (4 * r + shift) * std::pow(2 * r - shift, 2) / 12 : 0;
    EXPECT_NEAR(found.dice, lens / (4.0 / 3 * r * r * r), 0.001);
  }
}

/// The inner surface alone is apart from the solid ball's, and so the two directions differ.
TEST(CompareOutlines, WeighsBothDirectionsByArea) {
  const OutlineComparison found = compare_outlines(ball(middle, 10), shell(middle, 10, 6));
  EXPECT_NEAR(found.mean_mm, 4 * 36.0 / (100 + 100 + 36), 0.01);
  EXPECT_NEAR(found.largest_mm, 4, 0.01);
  EXPECT_NEAR(found.p95_mm, 4, 0.01);
  EXPECT_NEAR(found.dice, 2 * (1000.0 - 216) / (1000 + 1000 - 216), 0.001);
  const OutlineComparison back = compare_outlines(shell(middle, 10, 6), ball(middle, 10));
  EXPECT_NEAR(back.mean_mm, found.mean_mm, 1e-9) << "in whichever order";
}

TEST(CompareOutlines, AMarginIsTheSmallestWayAndNegativeWhereTheyOverlap) {
  const auto margin = [](const ComparedOutline& a, const ComparedOutline& b) { return margin_mm(a, b); };
  const ComparedOutline one = ball(middle, 10);
  EXPECT_NEAR(margin(one, ball(middle + 20.0 * oblique, 4)), 6, 0.02);
  EXPECT_NEAR(margin(ball(middle + 20.0 * oblique, 4), one), 6, 0.02);
  EXPECT_NEAR(margin(one, ball(middle + 40.0 * oblique, 4)), 26, 0.02) << "far: by points";
  EXPECT_NEAR(margin(one, ball(middle + 13.0 * oblique, 4)), -1, 0.02);
  EXPECT_LT(margin(one, ball(middle, 4)), -5.9) << "one within the other";
  EXPECT_LT(margin(ball(middle, 4), one), -5.9);
}

TEST(CompareOutlines, RefusesWhatHasNoSurface) {
  const ComparedOutline none = outline([](const Vec3&) { return -1.0; }, middle, 5);
  try {
    compare_outlines(none, ball(middle, 5));
    FAIL();
  } catch (const DicomError& error) {
    EXPECT_STREQ(error.what(), "one of the structures has no surface that could be compared");
  }
}

}  // namespace
}  // namespace palpate::io
