// Contours with keyholes: each outline is joined to its own holes, whatever the order of the lines.
#include "io/structures/keyholes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace palpate::io {
namespace {

/// A regular polygon.
struct Ring {
  glm::dvec2 middle{0};
  double radius = 1;
  int points = 12;

  double area() const { return 0.5 * points * radius * radius * std::sin(2 * std::numbers::pi / points); }
  ContourPolygon line(bool is_hole) const {
    ContourPolygon line;
    for (int n = 0; n < points; ++n) {
      const double turn = 0.3 + 2 * std::numbers::pi * n / points;
      line.push_back(middle + radius * glm::dvec2(std::cos(turn), std::sin(turn)));
    }
    if (is_hole) std::ranges::reverse(line);
    return line;
  }
};

struct OutlineWithHoles {
  Ring outer;
  std::vector<Ring> holes;

  double area() const {
    double area = outer.area();
    for (const Ring& hole : holes) area -= hole.area();
    return area;
  }
  std::size_t points() const {  // each hole is closed, and has a way back
    auto points = static_cast<std::size_t>(outer.points);
    for (const Ring& hole : holes) points += static_cast<std::size_t>(hole.points) + 2;
    return points;
  }
};

/// The second lies in the hole of the first.
std::vector<OutlineWithHoles> outlines_with_holes() {
  return {{{{0, 0}, 30, 40}, {{{0, 0}, 20, 31}}},
          {{{3, -2}, 12, 17}, {{{3, -2}, 5, 9}}},
          {{{70, 10}, 15, 24}, {{{64, 10}, 4, 7}, {{76, 12}, 5, 11}}},
          {{{70, -40}, 8, 13}, {}}};
}

/// By the trapezoids below its sides.
double area_below(const ContourPolygon& line) {
  double area = 0;
  for (std::size_t n = 0; n < line.size(); ++n) {
    const glm::dvec2 a = line[n], b = line[(n + 1) % line.size()];
    area += (a.x - b.x) * (a.y + b.y) / 2;
  }
  return area;
}

double length_of(const ContourPolygon& line) {
  double length = 0;
  for (std::size_t n = 0; n < line.size(); ++n) length += glm::distance(line[n], line[(n + 1) % line.size()]);
  return length;
}

TEST(Keyholes, EachOutlineIsJoinedToItsOwnHoles) {
  std::vector<OutlineWithHoles> outlines = outlines_with_holes();
  std::ranges::sort(outlines, {}, &OutlineWithHoles::area);
  std::vector<ContourPolygon> lines;
  for (const OutlineWithHoles& one : outlines) {
    lines.push_back(one.outer.line(false));
    for (const Ring& hole : one.holes) lines.push_back(hole.line(true));
  }
  std::mt19937 random(4);
  for (int round = 0; round < 40; ++round) {
    std::ranges::shuffle(lines, random);
    std::vector<ContourPolygon> joined = with_keyholes(lines);
    ASSERT_EQ(joined.size(), outlines.size());
    std::ranges::sort(joined, {}, area_below);
    for (std::size_t n = 0; n < joined.size(); ++n) {
      EXPECT_NEAR(area_below(joined[n]), outlines[n].area(), 1e-9) << round << ' ' << n;
      EXPECT_EQ(joined[n].size(), outlines[n].points()) << round << ' ' << n;
    }
  }
}

TEST(Keyholes, TheWayToAHoleIsTheShortestOfTwoPoints) {
  for (const OutlineWithHoles& one : outlines_with_holes()) {
    for (const Ring& ring : one.holes) {
      const ContourPolygon outer = one.outer.line(false), hole = ring.line(true);
      double least = std::numeric_limits<double>::infinity();
      for (const glm::dvec2& a : outer) {
        for (const glm::dvec2& b : hole) least = std::min(least, glm::distance(a, b));
      }
      const std::vector<ContourPolygon> joined = with_keyholes({hole, outer});
      ASSERT_EQ(joined.size(), 1U);
      EXPECT_NEAR(length_of(joined[0]), length_of(outer) + length_of(hole) + 2 * least, 1e-9);
    }
  }
}

TEST(Keyholes, WithoutHolesTheLinesStayAsTheyAre) {
  const ContourPolygon one = Ring{{0, 0}, 3, 5}.line(false), other = Ring{{9, 0}, 2, 4}.line(false);
  EXPECT_EQ(with_keyholes({one, other}), (std::vector<ContourPolygon>{one, other}));
  EXPECT_TRUE(with_keyholes({}).empty());
}

}  // namespace
}  // namespace palpate::io
