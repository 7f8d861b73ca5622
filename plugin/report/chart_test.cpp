#include "plugin/report/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate::plugin {
namespace {

/// The first and the last column of a canvas that holds red, or row.
std::pair<int, int> lines_in_red(const Canvas& canvas, bool of_columns) {
  const auto pixels = canvas.pixels();
  std::pair<int, int> found{std::max(canvas.width(), canvas.height()), -1};
  for (std::size_t n = 0; 4 * n < pixels.size(); ++n) {
    if (pixels[4 * n] > 100 || pixels[4 * n + 1] > 100 || pixels[4 * n + 2] < 200) continue;
    const int pixel = static_cast<int>(n);
    const int line = of_columns ? pixel % canvas.width() : pixel / canvas.width();
    found = {std::min(found.first, line), std::max(found.second, line)};
  }
  return found;
}
std::pair<int, int> columns_in_red(const Canvas& canvas) {
  return lines_in_red(canvas, true);
}
std::pair<int, int> rows_in_red(const Canvas& canvas) {
  return lines_in_red(canvas, false);
}

/// A logarithmic axis ends at the next 1, 2 or 5 of a decade, and each value is where its logarithm is between them.
TEST(Chart, ALogarithmicAxisEndsAtTheNextRoundNumber) {
  struct Case {
    double low, high, axis_low, axis_high;
  };
  constexpr int width = 960;
  const ChartStyle style;
  for (const Case& c :
       {Case{2, 50, 2, 50}, Case{1, 1000, 1, 1000}, Case{2.1, 1073, 2, 2000}, Case{0.016, 19.7, 0.01, 20},
        Case{3, 7, 2, 10}, Case{0.3, 0.4, 0.2, 0.5}, Case{4.9, 51, 2, 100}, Case{5, 5.1, 5, 10}}) {
    Canvas canvas(width, 300, colors::white);
    Chart chart;
    chart.x.logarithmic = true;
    chart.y = {.minimum = 0, .maximum = 2};
    chart.curves.push_back({.x = {c.low, c.high}, .y = {1, 1}, .color = {1, 0, 0}, .width = 4});
    draw(canvas, std::span(&chart, 1), style);
    const auto column_of = [&](double value) {
      const double part = std::log(value / c.axis_low) / std::log(c.axis_high / c.axis_low);
      return style.left + part * (width - style.left - style.right);
    };
    const auto [first, last] = columns_in_red(canvas);
    EXPECT_NEAR(first, column_of(c.low), 3) << c.low;
    EXPECT_NEAR(last, column_of(c.high), 3) << c.high;
  }
}

/// Where a curve is drawn whose values lie at a part of the y axis, and where it is due.
struct DrawnCurve {
  int first, last;  ///< its rows
  double value_row, axis_row;
};
DrawnCurve drawn_at(double part, bool logarithmic, Curve curve) {
  constexpr int width = 400, height = 300;
  const ChartStyle style;
  Canvas canvas(width, height, colors::white);
  Chart chart;
  chart.x = {.minimum = 0, .maximum = 2};
  chart.y = {.logarithmic = logarithmic, .minimum = 1, .maximum = 100};
  curve.y.assign(curve.x.size(), logarithmic ? std::pow(100, part) : 1 + 99 * part);
  curve.color = {1, 0, 0};
  chart.curves.push_back(std::move(curve));
  draw(canvas, std::span(&chart, 1), style);
  const auto [first, last] = rows_in_red(canvas);
  const double low_end = height - style.bottom, high_end = style.top;
  return {first, last, low_end + part * (high_end - low_end), low_end};
}

/// A larger value stands higher: each disc is where its value is between the bottom of the axes and their top.
TEST(Chart, LargerValuesStandHigher) {
  for (const bool logarithmic : {false, true}) {
    for (const double part : {0.1, 0.3, 0.5, 0.8, 0.95}) {
      const DrawnCurve disc =
          drawn_at(part, logarithmic, {.x = {1}, .y = {}, .style = Curve::Style::points, .width = 4});
      EXPECT_NEAR(0.5 * (disc.first + disc.last), disc.value_row, 2) << part;
    }
  }
}

/// A bar stands on the axis, and its top is where its value is.
TEST(Chart, ABarStandsOnTheAxis) {
  for (const bool logarithmic : {false, true}) {
    for (const double part : {0.1, 0.3, 0.5, 0.8, 0.95}) {
      const DrawnCurve bars = drawn_at(part, logarithmic, {.x = {0.5, 1.5}, .y = {}, .style = Curve::Style::bars});
      EXPECT_NEAR(bars.first, bars.value_row, 2) << part;
      EXPECT_NEAR(bars.last + 1, bars.axis_row, 2) << part;
    }
  }
}

/// Without limits a twentieth of the range is left above the values and below them, wherever they lie.
TEST(Chart, ATwentiethOfTheRangeIsLeftAtBothEnds) {
  constexpr int height = 300;
  const ChartStyle style;
  for (const double low : {0.0, 10.0, -500.0}) {
    Canvas canvas(400, height, colors::white);
    Chart chart;
    chart.curves.push_back({.x = {0, 1, 2, 3},
                            .y = {low, low, low + 1, low},
                            .color = {1, 0, 0},
                            .style = Curve::Style::points,
                            .width = 3});
    draw(canvas, std::span(&chart, 1), style);
    const auto [first, last] = rows_in_red(canvas);
    const double left_free = 0.05 / 1.1 * (height - style.top - style.bottom);
    EXPECT_NEAR(first + 3, style.top + left_free, 2) << low;
    EXPECT_NEAR(last - 2, height - style.bottom - left_free, 2) << low;
  }
}

/// Where lines cross the whole panel, inside of its frame: of the x axis as columns, of the y axis as rows.
std::vector<double> grid_of(const Chart& chart, bool of_x, int width, int height) {
  const ChartStyle style;
  Canvas canvas(width, height, colors::white);
  draw(canvas, std::span(&chart, 1), style);
  const auto pixels = canvas.pixels();
  const int left = static_cast<int>(style.left), top = static_cast<int>(style.top);
  const int right = width - static_cast<int>(style.right), bottom = height - static_cast<int>(style.bottom);
  std::vector<double> lines;
  double sum = 0, weight = 0;
  for (int at = (of_x ? left : top) + 3; at < (of_x ? right : bottom) - 3; ++at) {
    int lightest = 0;
    for (int along = (of_x ? top : left) + 3; along < (of_x ? bottom : right) - 3; ++along) {
      const int row = of_x ? along : at, column = of_x ? at : along;
      lightest = std::max<int>(lightest, pixels[4 * static_cast<std::size_t>(row * width + column)]);
    }
    const double dark = 255.0 - lightest;
    sum += dark * (at + 0.5);
    weight += dark;
    if (dark == 0 && weight > 0) {
      lines.push_back(sum / weight);
      sum = weight = 0;
    }
  }
  return lines;
}

/// Lines stand at multiples of 1, 2 or 5 times a power of ten, one at about each 45 pixels of the y axis and 91 of the
/// x axis.
TEST(Chart, LinesAreAtRoundNumbersNeitherCrowdedNorRare) {
  constexpr int width = 700, height = 420;
  const ChartStyle style;
  for (const bool of_x : {false, true}) {
    for (const double high : {0.37, 1.0, 7.0, 90.0, 1234.0}) {
      Chart chart;
      (of_x ? chart.x : chart.y) = {.minimum = 0, .maximum = high};
      const std::vector<double> lines = grid_of(chart, of_x, width, height);
      ASSERT_GE(lines.size(), 2U);
      const double length = of_x ? width - style.left - style.right : height - style.top - style.bottom;
      const double apart = (of_x ? 7 : 3.5) * style.text;
      const double step = std::abs(lines[1] - lines[0]);
      EXPECT_GT(step, 0.98 * apart) << high;
      EXPECT_LT(step, 2.6 * apart) << high;
      const double value = step / length * high, decade = std::pow(10, std::floor(std::log10(value) + 0.01));
      EXPECT_TRUE(std::abs(value / decade - 1) < 0.1 || std::abs(value / decade - 2) < 0.1 ||
                  std::abs(value / decade - 5) < 0.1)
          << value;
      for (std::size_t n = 0; n < lines.size(); ++n) {
        const double from_zero = of_x ? lines[n] - style.left : height - style.bottom - lines[n];
        EXPECT_NEAR(from_zero / step, std::round(from_zero / step), 0.03) << high;
      }
    }
  }
}

TEST(Chart, ALogarithmicAxisHasALineAtEachDecade) {
  constexpr int width = 700, height = 300;
  const ChartStyle style;
  Chart chart;
  chart.y = {.logarithmic = true, .minimum = 1, .maximum = 1e4};
  const std::vector<double> lines = grid_of(chart, false, width, height);
  ASSERT_EQ(lines.size(), 3U) << "and two at the ends";
  for (std::size_t n = 0; n < 3; ++n) {
    const double part = 0.25 * static_cast<double>(3 - n);
    EXPECT_NEAR(lines[n], height - style.bottom - part * (height - style.top - style.bottom), 1);
  }
}

/// In the legend a mark stands right beside its word, and is no higher than it.
TEST(Chart, ALegendsMarkStandsBesideItsWord) {
  constexpr int width = 500;
  const ChartStyle style;
  for (const Curve::Style of : {Curve::Style::points, Curve::Style::line}) {
    Canvas canvas(width, 300, colors::white);
    Chart chart;
    chart.curves.push_back({.label = "HHHH", .x = {}, .y = {}, .color = {1, 0, 0}, .style = of});
    draw(canvas, std::span(&chart, 1), style);
    const auto [first, last] = columns_in_red(canvas);
    const auto [top, bottom] = rows_in_red(canvas);
    const double word = width - style.right - canvas.text_width("HHHH", 12);
    EXPECT_GT(last, 0);
    EXPECT_LT(last, word);
    EXPECT_GT(last, word - 14);
    EXPECT_LE(last - first, 25);
    EXPECT_LE(bottom - top, 10);
  }
}

/// A band is seen only as far as it lies on the axis.
TEST(Chart, ABandEndsWhereTheAxisDoes) {
  constexpr int width = 400;
  const ChartStyle style;
  struct Case {
    double from, to;  ///< on an axis from 0 to 2
    double first, last;
  };
  for (const Case& c :
       {Case{0.5, 1, 0.5, 1}, Case{-3, 1, 0, 1}, Case{1.5, 9, 1.5, 2}, Case{3, 4, 1, 0}, Case{-4, -3, 1, 0}}) {
    Canvas canvas(width, 300, colors::white);
    Chart chart;
    chart.x = {.minimum = 0, .maximum = 2, .numbered = false};
    chart.bands.push_back({c.from, c.to, "", {1, 0, 0}});
    draw(canvas, std::span(&chart, 1), style);
    const auto [first, last] = columns_in_red(canvas);
    if (c.first > c.last) {
      EXPECT_EQ(last, -1) << c.from;
      continue;
    }
    const double per_unit = (width - style.left - style.right) / 2;
    EXPECT_NEAR(first, style.left + c.first * per_unit, 2);
    EXPECT_NEAR(last + 1, style.left + c.last * per_unit, 2);
  }
}

/// Panels share the height of a picture, the first on top.
TEST(Chart, PanelsStandBelowOneAnother) {
  constexpr int height = 600;
  const ChartStyle style;
  for (const int at : {0, 1, 2}) {
    std::array<Chart, 3> charts;
    for (Chart& chart : charts) chart.y = {.minimum = 0, .maximum = 2};
    charts[static_cast<std::size_t>(at)].curves.push_back(
        {.x = {1}, .y = {1}, .color = {1, 0, 0}, .style = Curve::Style::points, .width = 4});
    Canvas canvas(400, height, colors::white);
    draw(canvas, charts, style);
    const auto [first, last] = rows_in_red(canvas);
    const double panel = height / 3.0;
    EXPECT_NEAR(0.5 * (first + last), at * panel + style.top + 0.5 * (panel - style.top - style.bottom), 2);
  }
}

}  // namespace
}  // namespace palpate::plugin
