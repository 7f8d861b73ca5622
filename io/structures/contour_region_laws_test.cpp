/// The region filled by contours of one plane in any arrangement: rectangles and circles with known areas and
/// distances.

#include "io/structures/contour_region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/structures/contour_planes.h"

namespace palpate::io {
namespace {

using Polygons = std::vector<ContourPolygon>;

/// Rectangles turned by an angle, drawn either way round from any corner.
struct Drawing {
  explicit Drawing(unsigned seed) : random(seed), turned(any(0, 6)) {}

  double any(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  glm::dvec2 at(double x, double y) const {
    return {40 + x * std::cos(turned) - y * std::sin(turned), -90 + x * std::sin(turned) + y * std::cos(turned)};
  }
  ContourPolygon drawn(ContourPolygon polygon) {
    std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(random() % polygon.size()),
                polygon.end());
    if (random() % 2 == 0) std::ranges::reverse(polygon);
    return polygon;
  }
  ContourPolygon rectangle(double x0, double y0, double x1, double y1) {
    return drawn({at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)});
  }
  /// The same with points between.
  ContourPolygon finer(const ContourPolygon& polygon) {
    ContourPolygon fine;
    for (std::size_t n = 0; n < polygon.size(); ++n) {
      fine.push_back(polygon[n]);
      fine.push_back(polygon[n] + any(0.2, 0.8) * (polygon[(n + 1) % polygon.size()] - polygon[n]));
    }
    return drawn(std::move(fine));
  }

  std::mt19937 random;
  double turned;
};

double filled_mm2(const Polygons& contours, bool is_exclusive = false) {
  glm::dvec2 moment;
  return area_of(region_of(contours, is_exclusive).edges, moment);
}

TEST(ContourRegionLaws, TheSameContourTwiceCountsOnceAndIsCounted) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Drawing draw(seed);
    const double wide = draw.any(5, 60), tall = draw.any(5, 60);
    const ContourPolygon outer = draw.rectangle(0, 0, wide, tall), hole = draw.rectangle(1, 1, wide / 2, tall / 2);
    Polygons contours{outer, draw.finer(outer), hole, draw.drawn(hole), draw.drawn(outer)};
    std::ranges::shuffle(contours, draw.random);
    const ContourRegion region = region_of(contours, false);
    EXPECT_EQ(region.doubled, 3) << seed;
    EXPECT_FALSE(region.is_overlap) << seed;
    EXPECT_NEAR(filled_mm2(contours), wide * tall - (wide / 2 - 1) * (tall / 2 - 1), 1e-5) << seed;
  }
}

TEST(ContourRegionLaws, ContoursThatOverlapAreJoinedAndCounted) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Drawing draw(seed);
    const double x = draw.any(1, 19), y = draw.any(1, 19), wide = draw.any(20, 40), tall = draw.any(20, 40);
    Polygons contours{draw.rectangle(0, 0, 20, 20), draw.rectangle(x, y, x + wide, y + tall)};
    std::ranges::shuffle(contours, draw.random);
    EXPECT_TRUE(region_of(contours, false).is_overlap) << seed;
    const double shared = (20 - x) * (20 - y);
    EXPECT_NEAR(filled_mm2(contours), 400 + wide * tall - shared, 1e-5) << seed;
    EXPECT_NEAR(filled_mm2(contours, true), 400 + wide * tall - 2 * shared, 1e-5) << seed << ": exclusive or";
  }
}

TEST(ContourRegionLaws, AContourThatCrossesItselfFillsBothItsLobes) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Drawing draw(seed);
    // Two triangles that meet in a point, at any share of the way.
    const double wide = draw.any(5, 40), left = draw.any(5, 40), right = draw.any(5, 40);
    const ContourPolygon bow = draw.drawn({draw.at(0, 0), draw.at(wide, right), draw.at(wide, 0), draw.at(0, left)});
    const double cross = wide * left / (left + right);
    EXPECT_NEAR(filled_mm2({bow}), left * cross / 2 + right * (wide - cross) / 2, 1e-5) << seed;
    EXPECT_FALSE(region_of({bow}, false).is_overlap) << seed;
  }
}

// Lies anywhere in space, on planes of its own: refused neither as not parallel nor as without an area.
TEST(ContourRegionLaws, ABowTieAloneHasAPlane) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Drawing draw(seed);
    const Vec3 u = glm::normalize(Vec3(draw.any(-1, 1), draw.any(-1, 1), 1));
    const Vec3 v = glm::normalize(glm::cross(u, Vec3(1, draw.any(-1, 1), 0))), n = glm::cross(u, v);
    std::vector<Contour> contours;
    for (int k = 0; k < 3; ++k) {
      Contour contour;
      for (const auto& p : {glm::dvec2(0, 0), {20, 20}, {20, 0}, {0, 20}})
        contour.push_back(p.x * u + p.y * v + 2.0 * k * n);
      contours.push_back(contour);
    }
    EXPECT_NEAR(measures_of(contours).volume_mm3, 200 * 6, 1e-4) << seed;
  }
}

/// A keyhole's hole may run either way round.
TEST(ContourRegionLaws, AKeyholeCutsItsHoleWhicheverWayItRuns) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Drawing draw(seed);
    const double x = draw.any(2, 8), y = draw.any(2, 8), half = draw.any(0.5, 1.5);
    ContourPolygon hole{draw.at(x, y - half), draw.at(x + half, y), draw.at(x, y + half), draw.at(x - half, y)};
    if (seed % 2 == 0) std::reverse(hole.begin() + 1, hole.end());
    ContourPolygon keyhole{draw.at(0, 0), draw.at(x, 0)};
    keyhole.insert(keyhole.end(), hole.begin(), hole.end());
    keyhole.insert(keyhole.end(), {hole.front(), draw.at(x, 0), draw.at(12, 0), draw.at(12, 12), draw.at(0, 12)});
    EXPECT_NEAR(filled_mm2({draw.drawn(keyhole)}), 144 - 2 * half * half, 1e-5) << seed;
  }
}

// What abuts has no edge between, whichever way its parts run and wherever their corners meet; so does a hole's.
TEST(ContourRegionLaws, BetweenContoursThatAbutIsNoEdge) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Drawing draw(seed);
    const double x = draw.any(6, 12), y = draw.any(2, 16), off = seed % 3 == 0 ? draw.any(0, 4e-3) : 0;
    std::vector<ContourPolygon> parts{draw.rectangle(0, 0, x, 18), draw.rectangle(x + off, 0, 18, y),
                                      draw.rectangle(x + off, y, 18, 18)};
    std::ranges::shuffle(parts, draw.random);
    std::vector<Contour> contours;
    for (int k = 0; k < 9; ++k) {
      for (const ContourPolygon& part : parts) {
        Contour& contour = contours.emplace_back();
        for (const glm::dvec2& p : part) contour.emplace_back(p, 3.0 * k + 0.005);
      }
    }
    const ContourStack stack = stack_of(contours);
    EXPECT_EQ(stack.planes.front().polygons.size(), 1U) << seed;
    EXPECT_TRUE(stack.warnings.empty()) << seed;
    EXPECT_NEAR(measures_of(contours).volume_mm3, 18 * 18 * 27, 0.01 * 18 * 27) << seed;
    if (seed % 30 != 0) continue;
    const DistanceField field(planes_of(stack, {.reach_mm = 12}), {.reach_mm = 12});
    EXPECT_GT(field.sample(Vec3(draw.at(9, 9), 12.0)).mm, 8) << seed;
    EXPECT_NEAR(field.sample(Vec3(draw.at(x, 9), 12.0)).mm, std::min(x, 18 - x), 0.7) << seed;
  }
}

TEST(ContourRegionLaws, AreSaidOfTheStructure) {
  const auto square = [](double low, double high, double height) {
    return Contour{{low, low, height}, {high, low, height}, {high, high, height}, {low, high, height}};
  };
  const ContourStack doubled = stack_of({square(0, 9, 0), square(0, 9, 3), square(0, 9, 0), square(0, 9, 3)});
  ASSERT_EQ(doubled.warnings.size(), 1U);
  EXPECT_EQ(doubled.warnings[0], "2 of its contours are there twice: each counts once");
  const ContourStack overlapping = stack_of({square(0, 9, 0), square(0, 9, 3), square(5, 12, 3)});
  ASSERT_EQ(overlapping.warnings.size(), 1U);
  EXPECT_EQ(overlapping.warnings[0], "contours overlap in 1 of its planes: what lies inside any of them is inside");
}

// Every point lies less than 1000 m from the first, along either axis.
TEST(ContourRegionLaws, WhatSpansAThousandMetersIsRefused) {
  constexpr double limit_mm = 1e6;
  for (const glm::dvec2& way : {glm::dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    for (const double mm : {limit_mm - 1, limit_mm, limit_mm + 1}) {
      const glm::dvec2 aside(-way.y, way.x);
      const Polygons contours{{glm::dvec2(0), mm * way, 10.0 * aside}};
      if (mm < limit_mm) {
        EXPECT_NEAR(filled_mm2(contours), 5 * mm, 1) << way.x << ' ' << way.y;
      } else {
        EXPECT_THROW(region_of(contours, false), DicomError) << way.x << ' ' << way.y << ' ' << mm;
      }
    }
  }
}

std::string refusal_of_random(int contours, int points) {
  Drawing draw(1);
  Polygons all;
  for (int n = 0; n < contours; ++n) {
    ContourPolygon polygon;
    for (int k = 0; k < points; ++k) polygon.push_back(draw.at(draw.any(0, 30), draw.any(0, 30)));
    all.push_back(std::move(polygon));
  }
  try {
    region_of(all, false);
  } catch (const DicomError& error) {
    return error.what();
  }
  return "";
}

// What nobody draws ends soon.
TEST(ContourRegionLaws, WhatCrossesTooOftenIsRefused) {
  EXPECT_EQ(refusal_of_random(1, 100000),
            "a contour of it with 100000 points crosses itself too often: export it as SEG");
  EXPECT_EQ(refusal_of_random(1500, 8), "a plane of it has 1500 contours that overlap: export it as SEG");
  EXPECT_EQ(refusal_of_random(20, 20), "");
}

}  // namespace
}  // namespace palpate::io
