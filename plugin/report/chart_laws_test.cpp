/// What stands around a chart's curves: the numbers of its lines, its frame, its marks, and the legend.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "plugin/report/chart.h"

namespace palpate::plugin {
namespace {

/// Red, green and blue of a pixel.
std::array<int, 3> pixel_in(const Canvas& canvas, int column, int row) {
  const auto all = canvas.pixels();
  const auto at = 4 * (static_cast<std::size_t>(row) * canvas.width() + column);
  return {all[at + 2], all[at + 1], all[at]};
}

struct Columns {
  int first = 1 << 20, last = -1;
};

/// The columns that hold what is dark in some rows.
Columns dark_columns(const Canvas& canvas, int left, int right, int top, int bottom) {
  Columns found;
  for (int row = top; row < bottom; ++row) {
    for (int column = left; column < right; ++column) {
      if (pixel_in(canvas, column, row)[1] > 150) continue;
      found = {std::min(found.first, column), std::max(found.last, column)};
    }
  }
  return found;
}

/// Each line of the x axis has its number below it, and there is no number where no line is.
TEST(ChartLaws, EachLineOfTheXAxisHasItsNumberBelowIt) {
  constexpr int width = 700, height = 300;
  const ChartStyle style;
  for (const double unit : {1.0, 10.0, 1000.0}) {
    Chart chart;
    chart.x = {.minimum = 0, .maximum = 4 * unit};
    Canvas canvas(width, height, colors::white);
    draw(canvas, std::span(&chart, 1), style);
    const double per_unit = (width - style.left - style.right) / 4;
    const int top = height - static_cast<int>(style.bottom) + 5, bottom = height - 28;
    for (int n = 0; n <= 4; ++n) {
      const double line = style.left + n * per_unit;
      const int from = static_cast<int>(line - per_unit / 4);
      const int to = std::min(width, static_cast<int>(line + per_unit / 4));
      const Columns number = dark_columns(canvas, from, to, top, bottom);
      ASSERT_GE(number.last, 0) << n;
      EXPECT_NEAR(0.5 * (number.first + number.last + 1), line, 4) << n;
      if (n == 4) continue;
      const int next = static_cast<int>(line + 0.75 * per_unit);
      EXPECT_EQ(dark_columns(canvas, to, next, top, bottom).last, -1) << n;
    }
  }
}

/// The frame is around the axes, whatever the room beside them and the size of the picture.
TEST(ChartLaws, TheFrameIsAroundTheAxes) {
  for (const int width : {300, 500}) {
    for (const int height : {200, 350}) {
      for (const double left : {60.0, 90.0}) {
        ChartStyle style;
        style.left = left;
        Chart chart;
        chart.x = {.minimum = 0, .maximum = 1, .numbered = false};
        chart.y = {.minimum = 0, .maximum = 1};
        Canvas canvas(width, height, colors::white);
        draw(canvas, std::span(&chart, 1), style);
        // A frame's line is between two pixels, and a line of the y axis is lighter than both.
        const auto is_dark = [&](double x, double y, bool upright) {
          const int column = static_cast<int>(x), row = static_cast<int>(y);
          const int beside = upright ? pixel_in(canvas, column - 1, row)[0] : pixel_in(canvas, column, row - 1)[0];
          return std::min(beside, pixel_in(canvas, column, row)[0]) < 180;
        };
        const double right = width - style.right, bottom = height - style.bottom;
        for (const double part : {0.13, 0.57, 0.91}) {
          const double x = left + part * (right - left), y = style.top + part * (bottom - style.top);
          EXPECT_TRUE(is_dark(left, y, true)) << part;
          EXPECT_TRUE(is_dark(right, y, true)) << part;
          EXPECT_TRUE(is_dark(x, style.top, false)) << part;
          EXPECT_TRUE(is_dark(x, bottom, false)) << part;
          EXPECT_FALSE(is_dark(left + 9, y, true)) << part;
        }
      }
    }
  }
}

/// A mark's line is dashed, upright or level: so it is no curve.
TEST(ChartLaws, AMarksLineIsDashed) {
  constexpr int width = 400, height = 300;
  const ChartStyle style;
  for (const bool upright : {true, false}) {
    for (const double part : {0.3, 0.77}) {
      Chart chart;
      chart.x = {.minimum = 0, .maximum = 1, .numbered = false};
      chart.y = {.minimum = 0, .maximum = 1};
      chart.marks.push_back({part, "", {1, 0, 0}, upright});
      Canvas canvas(width, height, colors::white);
      draw(canvas, std::span(&chart, 1), style);
      const int left = static_cast<int>(style.left), right = width - static_cast<int>(style.right);
      const int top = static_cast<int>(style.top), bottom = height - static_cast<int>(style.bottom);
      const int line = static_cast<int>(upright ? left + part * (right - left) : bottom - part * (bottom - top));
      const int begin = (upright ? top : left) + 3, end = (upright ? bottom : right) - 3;
      int dashes = 0, reds = 0;
      bool was_red = false;
      for (int along = begin; along < end; ++along) {
        bool is_red = false;
        for (const int at : {line - 1, line, line + 1}) {
          const auto [red, green, blue] = upright ? pixel_in(canvas, at, along) : pixel_in(canvas, along, at);
          is_red = is_red || (red > 200 && green < 170 && blue < 170);
        }
        dashes += is_red && !was_red ? 1 : 0;
        reds += is_red ? 1 : 0;
        was_red = is_red;
      }
      EXPECT_GT(dashes, (end - begin) / 12);
      EXPECT_LT(reds, 0.9 * (end - begin));
      EXPECT_GT(reds, 0.3 * (end - begin));
    }
  }
}

/// In the legend a disc stands where a line of that name would.
TEST(ChartLaws, ALegendsDiscStandsWhereALineWould) {
  for (const char* const word : {"i", "force", "HHHHHHHH"}) {
    const auto mark = [&](Curve::Style of) {
      Chart chart;
      chart.curves.push_back({.label = word, .x = {}, .y = {}, .color = {1, 0, 0}, .style = of});
      Canvas canvas(500, 300, colors::white);
      draw(canvas, std::span(&chart, 1));
      Columns found;
      for (int row = 0; row < 34; ++row) {
        for (int column = 0; column < canvas.width(); ++column) {
          const auto [red, green, blue] = pixel_in(canvas, column, row);
          if (red < 200 || green > 100 || blue > 100) continue;
          found = {std::min(found.first, column), std::max(found.last, column)};
        }
      }
      return found;
    };
    const Columns line = mark(Curve::Style::line), disc = mark(Curve::Style::points);
    ASSERT_GE(disc.last, 0);
    EXPECT_GE(disc.first, line.first) << word;
    EXPECT_LE(disc.last, line.last) << word;
  }
}

/// The names of upright marks stand below one another, so that those of neighbors can be read.
TEST(ChartLaws, TheNamesOfNeighboringMarksStandBelowOneAnother) {
  constexpr int width = 500, height = 300;
  constexpr std::array words{"skin", "bone", "Halsschlagader", "air"};
  const ChartStyle style;
  for (const double apart : {0.0, 0.002, 0.05}) {
    int last_before = 0;
    for (std::size_t red = 0; red < words.size(); ++red) {
      Chart chart;
      chart.x = {.minimum = 0, .maximum = 1, .numbered = false};
      chart.y = {.minimum = 0, .maximum = 1};
      for (std::size_t n = 0; n < words.size(); ++n) {
        chart.marks.push_back(
            {0.3 + apart * static_cast<double>(n), words[n], n == red ? Color{1, 0, 0} : Color{0, 0, 1}});
      }
      Canvas canvas(width, height, colors::white);
      draw(canvas, std::span(&chart, 1), style);
      // Right of its own line, where its name begins.
      const int line = static_cast<int>(style.left + chart.marks[red].at * (width - style.left - style.right));
      int first = height, last = -1;
      for (int row = 0; row < height; ++row) {
        for (int column = line + 4; column < line + 30; ++column) {
          const auto [r, g, b] = pixel_in(canvas, column, row);
          if (r < g + 80 || r < b + 80) continue;
          first = std::min(first, row);
          last = std::max(last, row);
        }
      }
      ASSERT_GE(last, 0) << words[red];
      EXPECT_GT(first, last_before) << words[red] << " " << apart;
      last_before = last;
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
