#include "plugin/report/slice_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::plugin {
namespace {

constexpr double header = 34;        // pixels above the image, for the title
constexpr double mm_per_newton = 6;  // length of a force arrow

/// Maps patient points to pixels; points off the plane are projected onto it.
struct Projection {
  const SliceView& view;
  double pixels_per_mm;
  Point middle;

  Point operator()(const glm::dvec3& point_mm) const {
    const glm::dvec3 offset = point_mm - view.center_mm;
    return middle + pixels_per_mm * Point{glm::dot(offset, view.right), glm::dot(offset, view.down)};
  }
};

void draw_values(Canvas& canvas, const io::FieldSource& source, const Projection& projection) {
  const SliceView& view = projection.view;
  const int columns = canvas.width();
  const int rows = canvas.height() - static_cast<int>(header);
  std::vector<unsigned char> gray(static_cast<std::size_t>(columns) * rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double u = (column + 0.5 - projection.middle.x) / projection.pixels_per_mm;
      const double v = (row + 0.5 + header - projection.middle.y) / projection.pixels_per_mm;
      const io::Sample sample = source.sample(view.center_mm + u * view.right + v * view.down, io::FieldSet::value);
      const double level = (sample.value - view.window_level) / view.window_width + 0.5;
      gray[static_cast<std::size_t>(row) * columns + column] =
          sample.inside ? static_cast<unsigned char>(255.0 * std::clamp(level, 0.0, 1.0)) : 0;
    }
  }
  canvas.gray_image(gray, columns, rows, {0, header}, {columns, rows});
}

/// Text that stays readable over bone and air alike.
void label(Canvas& canvas, const Point& at, const std::string& words, double size, const Color& color,
           Anchor anchor = Anchor::left) {
  const double width = canvas.text_width(words, size);
  const double left = at.x - (anchor == Anchor::left ? 0 : anchor == Anchor::center ? width / 2 : width);
  canvas.rectangle({left - 4, at.y - size}, {width + 8, 1.35 * size}, {0, 0, 0, 0.55});
  canvas.text(at, words, size, color, anchor);
}

void draw_letters(Canvas& canvas, const SliceView& view) {
  const double middle_x = canvas.width() / 2.0;
  const double middle_y = header + (canvas.height() - header) / 2.0;
  label(canvas, {canvas.width() - 10.0, middle_y}, orientation_letters(view.right), 20, colors::yellow, Anchor::right);
  label(canvas, {10, middle_y}, orientation_letters(-view.right), 20, colors::yellow);
  label(canvas, {middle_x, canvas.height() - 10.0}, orientation_letters(view.down), 20, colors::yellow, Anchor::center);
  label(canvas, {middle_x, header + 22}, orientation_letters(-view.down), 20, colors::yellow, Anchor::center);
}

void draw_scales(Canvas& canvas, double pixels_per_mm) {
  const double bottom = canvas.height() - 16.0;
  const Point left{20, bottom};
  canvas.line(std::array{left, left + Point{10 * pixels_per_mm, 0}}, colors::white, 3);
  label(canvas, left + Point{0, -8}, "10 mm", 13, colors::white);
  const Point right{canvas.width() - 24.0 - 90, bottom};
  canvas.arrow(right, right + Point{mm_per_newton * pixels_per_mm, 0}, colors::green, 3);
  label(canvas, right + Point{0, -8}, "1 N", 13, colors::white);
}

}  // namespace

std::string orientation_letters(const glm::dvec3& direction) {
  constexpr std::array<std::array<const char*, 2>, 3> letters{{{"R", "L"}, {"A", "P"}, {"F", "H"}}};
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  const double largest = std::abs(direction[order[0]]);
  std::string words;
  for (const int axis : order) {
    // An axis counts where the direction leans to it by more than about 15 degrees; two letters say enough.
    if (words.size() < 2 && std::abs(direction[axis]) > 0.26 * largest && largest > 0) {
      words += letters[axis][direction[axis] > 0 ? 1 : 0];
    }
  }
  return words;
}

Canvas draw_slice(const io::FieldSource& source, const SliceView& view, std::span<const Track> tracks,
                  std::span<const ForceArrow> arrows, const std::string& title, int width, int height) {
  Canvas canvas(width, height, colors::white);
  const Projection projection{view, width / view.extent_mm, {width / 2.0, header + (height - header) / 2.0}};
  draw_values(canvas, source, projection);
  canvas.clip({0, header}, {static_cast<double>(width), height - header});
  for (const ForceArrow& arrow : arrows) {
    canvas.arrow(projection(arrow.at_mm), projection(arrow.at_mm + mm_per_newton * arrow.force_n), colors::green, 1.5);
  }
  double label_top = header + 24;
  for (const Track& track : tracks) {
    std::vector<Point> points;
    points.reserve(track.points_mm.size());
    std::transform(track.points_mm.begin(), track.points_mm.end(), std::back_inserter(points), projection);
    canvas.line(points, track.color, track.width);
    canvas.line(std::array{Point{14, label_top - 5}, Point{40, label_top - 5}}, track.color, 4);
    label(canvas, {48, label_top}, track.label, 14, colors::white);
    label_top += 20;
  }
  draw_letters(canvas, view);
  draw_scales(canvas, projection.pixels_per_mm);
  canvas.unclip();
  canvas.text({12, 23}, title, 15);
  return canvas;
}

void write_slice_png(const io::FieldSource& source, const SliceView& view, std::span<const Track> tracks,
                     std::span<const ForceArrow> arrows, const std::string& title, const std::filesystem::path& file,
                     int width, int height) {
  draw_slice(source, view, tracks, arrows, title, width, height).write_png(file);
}

}  // namespace palpate::plugin
