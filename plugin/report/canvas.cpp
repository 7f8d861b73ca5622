#include "plugin/report/canvas.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "plugin/messages/messages.h"

namespace palpate::plugin {

Canvas::Canvas(int width, int height, const Color& background)
    : width_(width),
      height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
      pen_(cairo_create(surface_.get()), cairo_destroy) {
  set(background);
  cairo_paint(pen_.get());
  cairo_select_font_face(pen_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_line_join(pen_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(pen_.get(), CAIRO_LINE_CAP_ROUND);
}

Color color_from(const std::string& hexadecimal, const Color& otherwise) {
  unsigned rgb = 0;
  const char* const end = hexadecimal.data() + hexadecimal.size();
  if (hexadecimal.size() != 7 || hexadecimal[0] != '#' ||
      std::from_chars(hexadecimal.data() + 1, end, rgb, 16).ptr != end) {
    return otherwise;
  }
  const auto part = [&](unsigned shift) { return (rgb >> shift & 0xFFU) / 255.0; };
  return {part(16), part(8), part(0)};
}

void Canvas::set(const Color& color) {
  cairo_set_source_rgba(pen_.get(), color.red, color.green, color.blue, color.alpha);
}

void Canvas::line(std::span<const Point> points, const Color& color, double width, bool dashed) {
  set(color);
  cairo_set_line_width(pen_.get(), width);
  const std::array dashes{4.0, 4.0};
  cairo_set_dash(pen_.get(), dashes.data(), dashed ? 2 : 0, 0);
  bool down = false;
  for (const Point& point : points) {
    // A point that is not a number lifts the pen: a gap in a curve.
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      down = false;
      continue;
    }
    if (down) {
      cairo_line_to(pen_.get(), point.x, point.y);
    } else {
      cairo_move_to(pen_.get(), point.x, point.y);
    }
    down = true;
  }
  cairo_stroke(pen_.get());
  cairo_set_dash(pen_.get(), nullptr, 0, 0);
}

void Canvas::arrow(const Point& from, const Point& to, const Color& color, double width) {
  const Point along = to - from;
  const double length = std::hypot(along.x, along.y);
  if (!(length > 0)) {
    return;
  }
  const Point forward = along / length;
  const Point side{-forward.y, forward.x};
  const double head = std::min(9.0, 0.5 * length);
  const Point neck = to - head * forward;
  line(std::array{from, neck}, color, width);
  set(color);
  const Point a = neck + 0.4 * head * side;
  const Point b = neck - 0.4 * head * side;
  cairo_move_to(pen_.get(), to.x, to.y);
  cairo_line_to(pen_.get(), a.x, a.y);
  cairo_line_to(pen_.get(), b.x, b.y);
  cairo_close_path(pen_.get());
  cairo_fill(pen_.get());
}

void Canvas::disc(const Point& center, double radius, const Color& color) {
  set(color);
  cairo_arc(pen_.get(), center.x, center.y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(pen_.get());
}

void Canvas::rectangle(const Point& corner, const Point& size, const Color& color, bool filled) {
  set(color);
  cairo_set_line_width(pen_.get(), 1);
  cairo_rectangle(pen_.get(), corner.x, corner.y, size.x, size.y);
  if (filled) {
    cairo_fill(pen_.get());
  } else {
    cairo_stroke(pen_.get());
  }
}

double Canvas::text_width(const std::string& words, double size) {
  cairo_set_font_size(pen_.get(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(pen_.get(), words.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const Point& at, const std::string& words, double size, const Color& color, Anchor anchor,
                  bool turned) {
  const double shift = anchor == Anchor::left ? 0 : text_width(words, size) * (anchor == Anchor::center ? 0.5 : 1.0);
  cairo_set_font_size(pen_.get(), size);
  set(color);
  cairo_save(pen_.get());
  cairo_translate(pen_.get(), at.x, at.y);
  if (turned) {
    cairo_rotate(pen_.get(), -std::numbers::pi / 2);
  }
  cairo_move_to(pen_.get(), -shift, 0);
  cairo_show_text(pen_.get(), words.c_str());
  cairo_restore(pen_.get());
}

void Canvas::gray_image(std::span<const unsigned char> pixels, int columns, int rows, const Point& corner,
                        const Point& size) {
  std::vector<std::array<unsigned char, 3>> colors(pixels.size());
  std::transform(pixels.begin(), pixels.end(), colors.begin(), [](unsigned char gray) {
    return std::array{gray, gray, gray};
  });
  image(colors, columns, rows, corner, size);
}

void Canvas::image(std::span<const std::array<unsigned char, 3>> pixels, int columns, int rows, const Point& corner,
                   const Point& size) {
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows), cairo_surface_destroy);
  cairo_surface_flush(image.get());
  unsigned char* data = cairo_image_surface_get_data(image.get());
  const int stride = cairo_image_surface_get_stride(image.get());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto& [red, green, blue] = pixels[static_cast<std::size_t>(row) * columns + column];
      unsigned char* pixel = data + static_cast<std::ptrdiff_t>(row) * stride + static_cast<std::ptrdiff_t>(4) * column;
      pixel[0] = blue;  // CAIRO_FORMAT_RGB24 on a little-endian machine
      pixel[1] = green;
      pixel[2] = red;
    }
  }
  cairo_surface_mark_dirty(image.get());
  cairo_save(pen_.get());
  cairo_translate(pen_.get(), corner.x, corner.y);
  cairo_scale(pen_.get(), size.x / columns, size.y / rows);
  cairo_set_source_surface(pen_.get(), image.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(pen_.get()), CAIRO_FILTER_NEAREST);
  cairo_paint(pen_.get());
  cairo_restore(pen_.get());
}

std::span<const unsigned char> Canvas::pixels() const {
  cairo_surface_flush(surface_.get());
  // Cairo's rows of 32-bit pixels have no padding.
  return {cairo_image_surface_get_data(surface_.get()), 4 * static_cast<std::size_t>(width_) * height_};
}

void Canvas::clip(const Point& corner, const Point& size) {
  cairo_save(pen_.get());
  cairo_rectangle(pen_.get(), corner.x, corner.y, size.x, size.y);
  cairo_clip(pen_.get());
}

void Canvas::unclip() {
  cairo_restore(pen_.get());
}

void Canvas::write_png(const std::filesystem::path& file) const {
  const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), file.c_str());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw Refusal(say("cannot-write-the-picture", file.string(), cairo_status_to_string(status)));
  }
}

}  // namespace palpate::plugin
