#include "plugin/report/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

/// A larger value stands higher: each disc is where its value is between the bottom of the axes and their top.
TEST(Chart, LargerValuesStandHigher) {
  constexpr int width = 400, height = 300;
  const ChartStyle style;
  const double low_end = height - style.bottom, high_end = style.top;
  for (const bool logarithmic : {false, true}) {
    for (const double part : {0.1, 0.3, 0.5, 0.8, 0.95}) {
      Canvas canvas(width, height, colors::white);
      Chart chart;
      chart.x = {.minimum = 0, .maximum = 2};
      chart.y = {.logarithmic = logarithmic, .minimum = 1, .maximum = 100};
      const double value = logarithmic ? std::pow(100, part) : 1 + 99 * part;
      chart.curves.push_back({.x = {1}, .y = {value}, .color = {1, 0, 0}, .style = Curve::Style::points, .width = 4});
      draw(canvas, std::span(&chart, 1), style);
      const auto [first, last] = rows_in_red(canvas);
      EXPECT_NEAR(0.5 * (first + last), low_end + part * (high_end - low_end), 2) << part;
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
