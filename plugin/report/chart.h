#pragma once

/// Charts as pictures: curves over linear or logarithmic axes, one panel or several below one another.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "plugin/report/canvas.h"

namespace palpate::plugin {

struct Axis {
  std::string label;  ///< with its unit: "depth (mm)"
  bool logarithmic = false;
  std::optional<double> minimum = std::nullopt;  ///< chosen from the data where not given
  std::optional<double> maximum = std::nullopt;
  bool numbered = true;  ///< false: without numbers, for a panel that compares bands
};

struct Curve {
  enum class Style { line, points, bars };
  std::string label;  ///< in the legend; empty: not in it
  std::vector<double> x, y;
  Color color = colors::blue;
  Style style = Style::line;
  double width = 1.8;  ///< of the line, or radius of the points: pixels
  bool dashed = false;
};

/// A dashed line across the panel with a word beside it.
struct Mark {
  double at = 0;
  std::string label;
  Color color = colors::gray;
  bool vertical = true;
};

/// An interval of the x axis behind the curves, with a word at the bottom if there is room.
struct Band {
  double from = 0, to = 0;
  std::string label;
  Color color = colors::light;
};

struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
  std::vector<Mark> marks;
  std::vector<Band> bands = {};
};

/// Room around the axes, pixels, and how large the text is.
struct ChartStyle {
  double left = 84, right = 24, top = 34, bottom = 50;
  double text = 13;
  bool titled = true;  ///< title and legend above the axes
};

/// Draws the panels below one another over the whole canvas.
void draw(Canvas& canvas, std::span<const Chart> panels, const ChartStyle& style = {});
/// Draws the panels below one another, each `height` pixels high. Throws std::runtime_error naming the file.
void write_png(std::span<const Chart> panels, const std::filesystem::path& file, int width = 960, int height = 330);
void write_png(const Chart& chart, const std::filesystem::path& file, int width = 960, int height = 540);

}  // namespace palpate::plugin
