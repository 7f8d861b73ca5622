// Lines where values on a lattice cross zero, over seeded values: each edge of the lattice is crossed once if its ends
// lie on different sides.
#include "io/structures/zero_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace palpate::io {
namespace {

struct ValuesOnALattice {
  glm::ivec2 nodes{0};
  std::vector<double> values;

  double at(int i, int j) const { return values[static_cast<std::size_t>(j * nodes.x + i)]; }
};

ValuesOnALattice seeded_values(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> any;
  ValuesOnALattice made{.nodes = {5 + static_cast<int>(seed % 9), 4 + static_cast<int>(seed % 7)}, .values = {}};
  for (int j = 0; j < made.nodes.y; ++j) {
    for (int i = 0; i < made.nodes.x; ++i) {
      const bool is_border = i == 0 || j == 0 || i == made.nodes.x - 1 || j == made.nodes.y - 1;
      const double value = any(random);
      made.values.push_back(is_border ? -std::abs(value) : value);
    }
  }
  return made;
}

bool before(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// By linear interpolation along each edge.
std::vector<glm::dvec2> crossings_of(const ValuesOnALattice& lattice) {
  std::vector<glm::dvec2> crossings;
  for (int j = 0; j < lattice.nodes.y; ++j) {
    for (int i = 0; i < lattice.nodes.x; ++i) {
      for (const glm::ivec2& step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
        if (i + step.x >= lattice.nodes.x || j + step.y >= lattice.nodes.y) continue;
        const double from = lattice.at(i, j), to = lattice.at(i + step.x, j + step.y);
        if ((from > 0) == (to > 0)) continue;
        crossings.push_back(glm::dvec2(i, j) + from / (from - to) * glm::dvec2(step));
      }
    }
  }
  return crossings;
}

TEST(ZeroLines, CrossEachEdgeOnceWhoseEndsLieOnDifferentSides) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const ValuesOnALattice lattice = seeded_values(seed);
    std::vector<glm::dvec2> expected = crossings_of(lattice), points;
    for (const ContourPolygon& line : zero_lines(lattice.values, lattice.nodes)) {
      points.insert(points.end(), line.begin(), line.end());
    }
    ASSERT_EQ(points.size(), expected.size()) << seed;
    std::ranges::sort(expected, before);
    std::ranges::sort(points, before);
    for (std::size_t n = 0; n < points.size(); ++n) {
      EXPECT_NEAR(points[n].x, expected[n].x, 1e-12) << seed;
      EXPECT_NEAR(points[n].y, expected[n].y, 1e-12) << seed;
    }
  }
}

TEST(ZeroLines, AreClosedWithWhatIsAboveZeroOnTheirLeft) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const ValuesOnALattice lattice = seeded_values(seed);
    for (const ContourPolygon& line : zero_lines(lattice.values, lattice.nodes)) {
      for (std::size_t n = 0; n < line.size(); ++n) {
        const glm::dvec2 a = line[n], along = line[(n + 1) % line.size()] - a;
        ASSERT_LE(std::abs(along.x), 1) << seed << ": through one cell";
        ASSERT_LE(std::abs(along.y), 1) << seed << ": through one cell";
        const glm::ivec2 low(static_cast<int>(std::floor(a.x)), static_cast<int>(std::floor(a.y)));
        const glm::ivec2 high(static_cast<int>(std::ceil(a.x)), static_cast<int>(std::ceil(a.y)));
        const glm::dvec2 above = glm::dvec2(lattice.at(low.x, low.y) > 0 ? low : high) - a;
        EXPECT_GT(along.x * above.y - along.y * above.x, 0) << seed;
      }
    }
  }
}

// Two corners above zero are joined across a cell if the mean of its four is above zero.
TEST(ZeroLines, TheMeanOfACellDecidesWhetherItsCornersAreJoined) {
  for (const bool is_mirrored : {false, true}) {
    for (const auto& [below, lines] : {std::pair{-0.5, 1U}, {-0.9, 1U}, {-1.1, 2U}, {-3.0, 2U}}) {
      std::vector<double> values(16, -1);
      values[is_mirrored ? 6 : 5] = values[is_mirrored ? 9 : 10] = 1;
      values[is_mirrored ? 5 : 6] = values[is_mirrored ? 10 : 9] = below;
      EXPECT_EQ(zero_lines(values, {4, 4}).size(), lines) << below;
    }
  }
}

}  // namespace
}  // namespace palpate::io
