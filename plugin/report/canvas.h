#pragma once

/// A picture being drawn with Cairo: 8-bit RGB, pixels from the upper left, written as PNG.

#include <array>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>

// Cairo's own names, declared here so that its header stays out of ours.
using cairo_t = struct _cairo;                  // NOLINT(bugprone-reserved-identifier)
using cairo_surface_t = struct _cairo_surface;  // NOLINT(bugprone-reserved-identifier)

namespace palpate::plugin {

using Point = glm::dvec2;

struct Color {
  double red = 0, green = 0, blue = 0, alpha = 1;
};

/// Of "#rrggbb"; `otherwise` for any other text.
Color color_from(const std::string& hexadecimal, const Color& otherwise);

/// Okabe and Ito's palette, which color-blind people can distinguish.
namespace colors {
constexpr Color black{0, 0, 0}, white{1, 1, 1}, gray{0.45, 0.45, 0.45}, light{0.88, 0.88, 0.88};
constexpr Color orange{0.90, 0.62, 0}, sky{0.34, 0.71, 0.91}, green{0, 0.62, 0.45}, yellow{0.94, 0.89, 0.26};
constexpr Color blue{0, 0.45, 0.70}, vermilion{0.84, 0.37, 0}, purple{0.80, 0.47, 0.65};
}  // namespace colors

enum class Anchor { left, center, right };

class Canvas {
 public:
  Canvas(int width, int height, const Color& background);

  int width() const { return width_; }
  int height() const { return height_; }

  void line(std::span<const Point> points, const Color& color, double width = 1.5, bool dashed = false);
  void arrow(const Point& from, const Point& to, const Color& color, double width = 1.5);
  void disc(const Point& center, double radius, const Color& color);
  void rectangle(const Point& corner, const Point& size, const Color& color, bool filled = true);
  /// Draws text with its anchor, on the baseline, at `at`; `turned`: upwards.
  void text(const Point& at, const std::string& words, double size = 13, const Color& color = colors::black,
            Anchor anchor = Anchor::left, bool turned = false);
  double text_width(const std::string& words, double size = 13);
  /// Gray values 0..255, row by row, stretched over the rectangle. Neighbors are smoothed over at most a pixel.
  void gray_image(std::span<const unsigned char> pixels, int columns, int rows, const Point& corner, const Point& size);
  /// The same in color: red, green, blue.
  void image(std::span<const std::array<unsigned char, 3>> pixels, int columns, int rows, const Point& corner,
             const Point& size);
  /// Restricts drawing to the rectangle until unclip().
  void clip(const Point& corner, const Point& size);
  void unclip();

  /// Row by row, 32 bits a pixel: blue, green, red, unused. Valid until something is drawn.
  std::span<const unsigned char> pixels() const;
  /// Throws std::runtime_error naming the file.
  void write_png(const std::filesystem::path& file) const;

 private:
  void set(const Color& color);

  int width_, height_;
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> pen_;
};

}  // namespace palpate::plugin
