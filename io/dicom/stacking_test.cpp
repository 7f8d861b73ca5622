// Laws of ordered slices, on oblique and skewed planes with pixels that are not square: evenness, missing slices and
// their messages, on both sides of each limit.
#include "io/dicom/stacking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/dicom/lattice.h"

namespace palpate::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Placement odd_place() {
  Placement place;
  place.direction_i = glm::normalize(Vec3(0.8, 0.3, -0.4));
  place.direction_j = glm::normalize(glm::cross(Vec3(0.2, -0.1, 1), place.direction_i) + 0.004 * place.direction_i);
  place.spacing_i = 0.7;
  place.spacing_j = 0.45;
  place.position = {-30, 12, 200};
  return place;
}

Vec3 normal_of(const Placement& place) {
  return glm::normalize(glm::cross(place.direction_i, place.direction_j));
}

/// Slices at these distances from each other along the normal, leaning by `tilt` mm along the columns for each mm.
std::vector<Vec3> stack(const std::vector<double>& intervals, double tilt = 0) {
  const Placement place = odd_place();
  std::vector<Vec3> positions{place.position};
  for (const double interval : intervals) {
    positions.push_back(positions.back() + interval * (normal_of(place) + tilt * place.direction_j));
  }
  return positions;
}

Geometry geometry_of_stack(const std::vector<Vec3>& positions, const std::vector<Vec3>& lost = {},
                           double thickness = 0) {
  return stack_geometry(14, 9, odd_place(), positions, lost, thickness);
}

TEST(Stacking, HeightsAreAlongTheNormalAndAPlaceIsAFiftiethOfTheFinerPixel) {
  Placement place = odd_place();
  const Vec3 normal = normal_of(place);
  const Vec3 at = 3.0 * place.direction_i - 8.0 * place.direction_j + 5.5 * normal;
  EXPECT_NEAR(height_of(at, place), 5.5, 1e-12);
  EXPECT_DOUBLE_EQ(same_place_mm(place), 0.02 * 0.45);
  std::swap(place.spacing_i, place.spacing_j);
  EXPECT_DOUBLE_EQ(same_place_mm(place), 0.02 * 0.45);
  EXPECT_EQ(millimeters(1.005e3), "1005.00 mm");
  EXPECT_EQ(millimeters(-0.126), "-0.13 mm");
}

TEST(Stacking, OneSliceHasItsThicknessForAStep) {
  for (const double thickness : {2.5, 0.0}) {
    const Geometry g = geometry_of_stack(stack({}), {}, thickness);
    EXPECT_EQ(g.dimensions, glm::ivec3(14, 9, 1));
    EXPECT_LT(glm::distance(g.step, normal_of(odd_place()) * (thickness > 0 ? thickness : 1)), 1e-12);
    EXPECT_TRUE(g.uniform);
  }
}

TEST(Stacking, IsEvenWhereEveryStepIsTheMeanOneToAFiftieth) {
  // Of ten steps one is longer by x and one shorter: the mean stays.
  for (const auto& [x, even] : {std::pair{0.019, true}, {0.021, false}}) {
    for (const double tilt : {0.0, 0.3}) {
      std::vector<double> intervals(10, 2.0);
      intervals[3] *= 1 + x;
      intervals[8] *= 1 - x;
      const std::vector<Vec3> positions = stack(intervals, tilt);
      const Geometry g = geometry_of_stack(positions);
      EXPECT_EQ(g.uniform, even) << x;
      EXPECT_LT(glm::distance(g.step, (positions.back() - positions.front()) / 10.0), 1e-12);
      EXPECT_EQ(g.spacing_i, 0.7);
      EXPECT_EQ(g.spacing_j, 0.45);
      EXPECT_THAT(g.gaps, IsEmpty());
    }
  }
  // And sideways: to one side, and back at the next.
  for (const auto& [x, even] : {std::pair{0.019, true}, {0.021, false}}) {
    std::vector<Vec3> positions = stack(std::vector<double>(10, 2.0));
    positions[5] += x * 2 * odd_place().direction_i;
    EXPECT_EQ(geometry_of_stack(positions).uniform, even) << x;
  }
}

TEST(Stacking, SlicesAreMissingWhereAnIntervalIsHalfAsLongAgainAndNoneOfAnEvenRun) {
  const auto gaps = [](const std::vector<double>& intervals) { return geometry_of_stack(stack(intervals, 0.2)).gaps; };
  EXPECT_THAT(gaps({2, 2, 2.98, 2, 2, 2}), IsEmpty());
  EXPECT_THAT(gaps({2, 2, 3.02, 2, 2, 2}), ElementsAre(2));
  EXPECT_THAT(gaps({4, 2, 2, 2, 2, 6}), ElementsAre(0, 5));
  // Two alike are no run, three are; and alike is what differs by a twentieth.
  EXPECT_THAT(gaps({2, 2, 2, 2, 5, 5, 2, 2, 2}), ElementsAre(4, 5));
  EXPECT_THAT(gaps({2, 2, 2, 2, 5, 5, 5, 2, 2, 2}), IsEmpty());
  EXPECT_THAT(gaps({2, 2, 2, 2, 5, 5.2, 5, 2, 2, 2}), IsEmpty());
  EXPECT_THAT(gaps({2, 2, 2, 2, 5, 5.3, 5, 2, 2, 2}), ElementsAre(4, 5, 6));
  EXPECT_THAT(gaps({5, 5, 5, 2, 2, 2, 2, 2}), IsEmpty());
  EXPECT_THAT(gaps({2, 2, 2, 2, 2, 5, 5, 5}), IsEmpty());
}

TEST(Stacking, WhereASliceIsLostThereIsAGapHoweverShort) {
  const std::vector<Vec3> positions = stack({2, 2, 2, 2}, 0.2);
  const auto gaps = [&](const Vec3& lost) { return geometry_of_stack(positions, {lost}).gaps; };
  const Vec3 up = positions[1] - positions[0];
  for (int k = 0; k < 4; ++k) {
    EXPECT_THAT(gaps(positions[static_cast<std::size_t>(k)] + 0.01 * up), ElementsAre(k));
    EXPECT_THAT(gaps(positions[static_cast<std::size_t>(k)] + 0.99 * up), ElementsAre(k));
  }
  EXPECT_THAT(gaps(positions.front() - up), IsEmpty());
  EXPECT_THAT(gaps(positions.back() + up), IsEmpty());
}

std::vector<std::string> words_of(const Geometry& geometry, double thickness = 0) {
  std::vector<std::string> words;
  for (const Text& text : geometry_warnings(geometry, thickness)) words.emplace_back(text);
  return words;
}

TEST(Stacking, WordsNameThePlaceTheCountAndTheDistances) {
  EXPECT_THAT(words_of(geometry_of_stack(stack({2, 2, 2, 2}, 0.2)), 2), IsEmpty());
  EXPECT_THAT(
      words_of(geometry_of_stack(stack({2, 4.1, 2, 2, 2, 8.25, 2}))),
      ElementsAre("1 slice is missing between slices 1 and 2 (4.10 mm apart, elsewhere 2.00 mm): nothing is felt there",
                  "3 slices are missing between slices 5 and 6 (8.25 mm apart, elsewhere 2.00 mm): nothing is felt "
                  "there"));
  // A slice is lost where hardly more than one step is left.
  const std::vector<Vec3> positions = stack({2, 2, 2, 2});
  EXPECT_THAT(words_of(geometry_of_stack(positions, {0.5 * (positions[2] + positions[3])})),
              ElementsAre("1 slice is missing between slices 2 and 3 (2.00 mm apart, elsewhere 2.00 mm): nothing is "
                          "felt there"));
  EXPECT_THAT(words_of(geometry_of_stack(stack({2, 2.1, 2.25, 1.9, 2}))),
              ElementsAre("slices are unevenly spaced, 1.90 mm to 2.25 mm apart: each is used where it is"));
  std::vector<Vec3> aside = stack({2, 2, 2, 2});
  aside[2] += 0.3 * odd_place().direction_i;
  const std::string sideways = "slices are displaced sideways against each other: each is used where it is";
  EXPECT_THAT(words_of(geometry_of_stack(aside)), ElementsAre(sideways));
  aside[3] += 0.036 * normal_of(odd_place());
  EXPECT_THAT(words_of(geometry_of_stack(aside)), ElementsAre("slices are unevenly spaced, 1.96 mm to 2.04 mm apart: "
                                                              "each is used where it is"));
}

TEST(Stacking, NeighborsOverlapWhereTheyAreHalfAThicknessApart) {
  const Geometry g = geometry_of_stack(stack({2, 2, 2}));
  for (const auto& [thickness, told] : {std::pair{4.0, true}, {3.7, true}, {3.6, false}, {2.0, false}, {0.0, false}}) {
    const std::vector<std::string> words = words_of(g, thickness);
    ASSERT_EQ(words.size(), told ? 1U : 0U) << thickness;
    if (!told) continue;
    EXPECT_TRUE(words[0].starts_with("slices are " + millimeters(thickness) + " thick and 2.00 mm apart, so that"));
  }
}

/// By the definitions in the header, height by height.
Overlap overlap_by_definition(const Lattice& a, const Lattice& b, double same) {
  const auto within = [&](const Lattice& one, const Lattice& other) {
    std::vector<double> away;
    for (const double height : one.heights) {
      if (height < other.heights.front() - same || height > other.heights.back() + same) continue;
      double nearest = 1e9;
      for (const double there : other.heights) nearest = std::min(nearest, std::abs(there - height));
      away.push_back(nearest);
    }
    std::sort(away.begin(), away.end());
    return away;
  };
  const std::vector<double> of_a = within(a, b), of_b = within(b, a);
  const std::vector<double>& fewer = of_b.size() < of_a.size() ? of_b : of_a;
  Overlap overlap;
  overlap.slices = fewer.size();
  if (fewer.empty()) return overlap;
  std::size_t at_one = 0;
  for (const double mm : fewer) at_one += mm <= same ? 1 : 0;
  overlap.coincide = at_one >= fewer.size() - at_one;
  overlap.shifted = of_a.size() < a.heights.size() && of_b.size() < b.heights.size();
  overlap.distance = fewer[fewer.size() / 2];
  return overlap;
}

TEST(Stacking, OverlapIsThatOfItsDefinition) {
  std::mt19937 random(7);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  std::array<int, 2> coinciding{}, shifted{};
  for (int n = 0; n < 400; ++n) {
    const auto lattice = [&] {
      Lattice one;
      double height = any(0, 20);
      const int count = 1 + static_cast<int>(any(0, 9));
      for (int k = 0; k < count; ++k, height += any(0.5, 4)) one.heights.push_back(height);
      return one;
    };
    const Lattice a = lattice();
    Lattice b = lattice();
    if (n % 2 == 0) {  // some at the very places of the other
      b.heights = a.heights;
      for (double& height : b.heights) height += any(-0.02, 0.04);
      if (n % 4 == 0) b.heights.push_back(b.heights.back() + 5);
      if (n % 8 == 0) b.heights.erase(b.heights.begin());
    }
    const Overlap found = overlap_of(a, b, 0.02), expected = overlap_by_definition(a, b, 0.02);
    EXPECT_EQ(found.slices, expected.slices) << n;
    EXPECT_EQ(found.coincide, expected.coincide) << n;
    EXPECT_EQ(found.shifted, expected.shifted) << n;
    EXPECT_DOUBLE_EQ(found.distance, expected.distance) << n;
    ++coinciding.at(expected.coincide ? 1 : 0);
    ++shifted.at(expected.shifted ? 1 : 0);
  }
  for (const int each : {0, 1}) {
    EXPECT_GT(coinciding.at(each), 20);
    EXPECT_GT(shifted.at(each), 20);
  }
}

TEST(Placement, IsOneWhereItsCosinesAreRoundedAndNoMore) {
  const auto is_one = [](double length_i, double length_j, double cosine) {
    const Vec3 i = length_i * Vec3(1, 0, 0), j = length_j * Vec3(cosine, std::sqrt(1 - cosine * cosine), 0);
    return make_placement({1, 2, 3}, {i.x, i.y, i.z, j.x, j.y, j.z}, {0.5, 0.75}).has_value();
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(is_one(1 + sign * 0.0099, 1, 0));
    EXPECT_FALSE(is_one(1 + sign * 0.0101, 1, 0));
    EXPECT_TRUE(is_one(1, 1 + sign * 0.0099, 0));
    EXPECT_FALSE(is_one(1, 1 + sign * 0.0101, 0));
    EXPECT_TRUE(is_one(1, 1, sign * 0.0099));
    EXPECT_FALSE(is_one(1, 1, sign * 0.0101));
  }
  const std::vector<double> position{1, 2, 3}, orientation{1, 0, 0, 0, 1, 0};
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    EXPECT_FALSE(make_placement(position, orientation, {bad, 1}));
    EXPECT_FALSE(make_placement(position, orientation, {1, bad}));
  }
  EXPECT_FALSE(make_placement({1, 2}, orientation, {1, 1}));
  EXPECT_FALSE(make_placement(position, {1, 0, 0, 0, 1}, {1, 1}));
  EXPECT_FALSE(make_placement(position, orientation, {1}));
  const auto place = make_placement(position, {0, 1, 0, 0, 0, -1}, {0.5, 0.75});  // between rows, between columns
  ASSERT_TRUE(place);
  EXPECT_EQ(place->position, Vec3(1, 2, 3));
  EXPECT_EQ(place->direction_i, Vec3(0, 1, 0));
  EXPECT_EQ(place->direction_j, Vec3(0, 0, -1));
  EXPECT_EQ(place->spacing_i, 0.75);
  EXPECT_EQ(place->spacing_j, 0.5);
}

}  // namespace
}  // namespace palpate::io::internal
