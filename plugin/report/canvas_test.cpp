/// What is drawn, pixel by pixel: an image's parts, a frame's width, how text stands by its anchor.

#include "plugin/report/canvas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

namespace palpate::plugin {
namespace {

/// Red, green and blue of a pixel.
std::array<int, 3> pixel_at(const Canvas& canvas, int column, int row) {
  const auto all = canvas.pixels();
  const auto at = 4 * (static_cast<std::size_t>(row) * canvas.width() + column);
  return {all[at + 2], all[at + 1], all[at]};
}

/// Each of an image's pixels is a square of its own color, up to the image's edges; outside it nothing is drawn.
TEST(Canvas, AnImageIsDrawnFromItsFirstPixelToItsLast) {
  constexpr int columns = 3, rows = 2, side = 10, left = 5, top = 7;
  const std::vector<std::array<unsigned char, 3>> parts{{250, 10, 20}, {30, 240, 50},   {60, 70, 230},
                                                        {80, 90, 100}, {110, 220, 130}, {200, 150, 160}};
  Canvas canvas(40, 30, colors::white);
  canvas.image(parts, columns, rows, {left, top}, {columns * side, rows * side});
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto& [red, green, blue] = parts[static_cast<std::size_t>(row) * columns + column];
      const std::array<int, 3> wanted{red, green, blue};
      const int x = left + column * side, y = top + row * side;
      EXPECT_EQ(pixel_at(canvas, x + side / 2, y + side / 2), wanted) << column << " " << row;
      EXPECT_EQ(pixel_at(canvas, x, y), wanted) << "its upper left corner";
      EXPECT_EQ(pixel_at(canvas, x + side - 1, y + side - 1), wanted) << "its lower right corner";
    }
  }
  const std::array<int, 3> white{255, 255, 255};
  EXPECT_EQ(pixel_at(canvas, left - 1, top + 1), white);
  EXPECT_EQ(pixel_at(canvas, left + columns * side, top + 1), white);
  EXPECT_EQ(pixel_at(canvas, left + 1, top - 1), white);
  EXPECT_EQ(pixel_at(canvas, left + 1, top + rows * side), white);
}

/// A frame is a pixel wide, however wide the line was that was drawn before.
TEST(Canvas, AFrameIsAPixelWide) {
  Canvas canvas(60, 40, colors::white);
  canvas.line(std::array{Point{5, 35}, Point{55, 35}}, colors::black, 9);
  canvas.rectangle({10.5, 5.5}, {40, 20}, colors::black, false);
  for (int column = 0; column < 60; ++column) {
    const std::array<int, 3> gray = pixel_at(canvas, column, 15);
    EXPECT_NEAR(gray[0], column == 10 || column == 50 ? 0 : 255, 9) << column;
  }
}

/// The first and the last column that is not white.
std::pair<int, int> inked(const Canvas& canvas) {
  std::pair<int, int> found{canvas.width(), -1};
  for (int row = 0; row < canvas.height(); ++row) {
    for (int column = 0; column < canvas.width(); ++column) {
      if (pixel_at(canvas, column, row)[0] > 200) continue;
      found = {std::min(found.first, column), std::max(found.second, column)};
    }
  }
  return found;
}

TEST(Canvas, TextStandsByItsAnchor) {
  for (const auto& [anchor, from] :
       {std::pair{Anchor::left, 0.0}, std::pair{Anchor::center, -0.5}, std::pair{Anchor::right, -1.0}}) {
    Canvas canvas(200, 40, colors::white);
    const double width = canvas.text_width("HHHH", 16);
    canvas.text({100, 30}, "HHHH", 16, colors::black, anchor);
    const auto [first, last] = inked(canvas);
    EXPECT_NEAR(first, 100 + from * width, 4);
    EXPECT_NEAR(last, 100 + (from + 1) * width, 4);
  }
}

/// An arrow's head is filled, wherever it points: its inside on both sides of its middle has the arrow's color.
TEST(Canvas, AnArrowsHeadIsFilled) {
  for (int turn = 0; turn < 16; ++turn) {
    const double angle = turn * std::numbers::pi / 8;
    const Point forward(std::cos(angle), std::sin(angle)), side(-forward.y, forward.x), from(50, 50);
    Canvas canvas(100, 100, colors::white);
    canvas.arrow(from, from + 40.0 * forward, colors::black);
    for (const double across : {-1.0, 1.0}) {
      const Point within = from + 34.0 * forward + across * side;  // 6 pixels behind the tip
      EXPECT_LT(pixel_at(canvas, static_cast<int>(within.x), static_cast<int>(within.y))[0], 128) << turn;
    }
  }
}

/// How far a place is from a stretch between two others.
double distance_to(const Point& at, const Point& from, const Point& to) {
  const Point along = to - from;
  const double part = std::clamp(glm::dot(at - from, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::distance(at, from + part * along);
}

/// A wide line has round corners: nothing of it is farther from its points' connection than half its width.
TEST(Canvas, ALinesCornersAreRound) {
  constexpr double width = 12;
  const Point corner(60, 60);
  for (const double opening : {0.5, 0.9, 1.4, 1.7}) {
    const Point a = corner + 40.0 * Point(-std::cos(opening / 2), std::sin(opening / 2));
    const Point b = corner + 40.0 * Point(-std::cos(opening / 2), -std::sin(opening / 2));
    Canvas canvas(120, 120, colors::white);
    canvas.line(std::array{a, corner, b}, colors::black, width);
    for (int row = 0; row < canvas.height(); ++row) {
      for (int column = 0; column < canvas.width(); ++column) {
        const Point at(column + 0.5, row + 0.5);
        const double far = std::min(distance_to(at, a, corner), distance_to(at, corner, b));
        const int gray = pixel_at(canvas, column, row)[0];
        ASSERT_TRUE(far > width / 2 + 1 ? gray > 200 : far > width / 2 - 1 || gray < 50) << column << " " << row;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
