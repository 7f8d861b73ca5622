#include "plugin/paraview/client/jobs/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include "io/load.h"
#include "plugin/paraview/common/scan_look.h"

namespace palpate::plugin {
namespace {

Window window_of(const io::Series& series, std::vector<double> values) {
  if (series.window) return {series.window->level, series.window->width};
  std::sort(values.begin(), values.end());
  const double low = values[values.size() / 100], high = values[values.size() - 1 - values.size() / 100];
  return {(low + high) / 2, std::max(high - low, 1e-6)};
}

}  // namespace

QImage thumbnail_of(const io::Series& series) {
  try {
    const int middle = series.geometry.dimensions.z / 2;
    const io::Volume slice = io::load(series, {.slices = io::LoadOptions::Range{.first = middle, .count = 1}});
    const glm::ivec3 size = slice.geometry.dimensions;
    const double wide = size.x * slice.geometry.spacing_i, high = size.y * slice.geometry.spacing_j;
    const double scale = thumbnail_pixels / std::max(wide, high);
    const int columns = std::max(1, static_cast<int>(std::lround(wide * scale)));
    const int rows = std::max(1, static_cast<int>(std::lround(high * scale)));
    std::vector<double> values;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) values.push_back(slice.value_at(x * size.x / columns, y * size.y / rows, 0));
    }
    const Window window = window_of(series, values);
    QImage image(columns, rows, QImage::Format_Grayscale8);
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const double part =
            (values[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] -
             window.level) /
                window.width +
            0.5;
        image.scanLine(y)[x] = static_cast<uchar>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
      }
    }
    return image;
  } catch (const std::exception&) {
    return {};  // told when the series is opened
  }
}

}  // namespace palpate::plugin
