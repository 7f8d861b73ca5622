/// The parts of a slice's picture besides the scan: the letters of the patient's sides, the forces and the scales.

#include "plugin/report/slice_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace palpate::plugin {
namespace {

constexpr int slice_width = 420, slice_height = 334;
constexpr double title_height = 34;  // pixels above the image

/// Nothing: all of the slice is black.
class NothingScanned : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override { return io::FieldSet::value; }
  io::Sample sample(const io::Vec3& /*position_mm*/, io::FieldSet /*wanted*/) const noexcept override { return {}; }
};

/// Pixels that are set, of a part of a picture.
struct Marked {
  int left = std::numeric_limits<int>::max(), top = left, right = -1, bottom = -1;
  std::vector<std::array<int, 2>> pixels;

  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
  Point middle() const {
    Point sum(0);
    for (const auto& [column, row] : pixels) sum += Point(column + 0.5, row + 0.5);
    return sum / static_cast<double>(pixels.size());
  }
  bool has(int column, int row) const {
    return std::ranges::find(pixels, std::array{left + column, top + row}) != pixels.end();
  }
};

using IsMarked = std::function<bool(int red, int green, int blue)>;

Marked marked_in(const Canvas& canvas, const Point& corner, const Point& end, const IsMarked& is_marked) {
  Marked marked;
  const auto pixels = canvas.pixels();
  for (int row = static_cast<int>(corner.y); row < static_cast<int>(end.y); ++row) {
    for (int column = static_cast<int>(corner.x); column < static_cast<int>(end.x); ++column) {
      const auto at = 4 * static_cast<std::size_t>(row * canvas.width() + column);
      if (!is_marked(pixels[at + 2], pixels[at + 1], pixels[at])) continue;
      marked.pixels.push_back({column, row});
      marked.left = std::min(marked.left, column);
      marked.right = std::max(marked.right, column);
      marked.top = std::min(marked.top, row);
      marked.bottom = std::max(marked.bottom, row);
    }
  }
  return marked;
}

bool is_yellow(int red, int green, int blue) {
  return red > 140 && green > 130 && blue < 110;
}

bool is_green(int red, int green, int blue) {
  return red < 60 && green > 100 && blue > 60;
}

bool is_white(int red, int green, int blue) {
  return std::min({red, green, blue}) > 200;
}

/// Pixels in which two shapes differ, laid upper left on upper left.
int difference(const Marked& a, const Marked& b) {
  int count = 0;
  for (int row = 0; row < std::max(a.height(), b.height()); ++row) {
    for (int column = 0; column < std::max(a.width(), b.width()); ++column) {
      if (a.has(column, row) != b.has(column, row)) ++count;
    }
  }
  return count;
}

/// The letter of the six that a shape looks like most; '?' where it looks like none.
char letter_like(const Marked& shape) {
  if (shape.pixels.empty()) return '?';
  char best = '?';
  int least = static_cast<int>(shape.pixels.size()) / 2;
  for (const char letter : {'R', 'L', 'A', 'P', 'F', 'H'}) {
    for (int part = 0; part < 16; ++part) {  // Cairo 1.18 draws text between pixels, too
      Canvas canvas(40, 40, colors::black);
      canvas.text({10 + part % 4 / 4.0, 30 + part / 4 / 4.0}, std::string(1, letter), 20, colors::yellow);
      const int far = difference(shape, marked_in(canvas, {0, 0}, {40, 40}, is_yellow));
      if (far >= least) continue;
      least = far;
      best = letter;
    }
  }
  return best;
}

/// LPS: x grows to the patient's left, y to the back (posterior), z to the head.
char side_of(const glm::dvec3& direction) {
  if (direction.x != 0) return direction.x > 0 ? 'L' : 'R';
  if (direction.y != 0) return direction.y > 0 ? 'P' : 'A';
  return direction.z > 0 ? 'H' : 'F';
}

std::vector<glm::dvec3> along_the_axes() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

/// At each edge stands the side of the patient that lies there, however the slice is hung.
TEST(SlicePicture, EachEdgeHasTheLetterOfTheSideThere) {
  const double width = slice_width, height = slice_height;
  const double middle_x = width / 2, middle_y = (height + title_height) / 2;
  for (const glm::dvec3& right : along_the_axes()) {
    for (const glm::dvec3& down : along_the_axes()) {
      if (glm::dot(right, down) != 0) continue;
      SliceView view;
      view.right = right;
      view.down = down;
      const Canvas canvas = draw_slice(NothingScanned(), view, {}, {}, "", slice_width, slice_height);
      const auto letter_in = [&](const Point& corner, const Point& end) {
        return letter_like(marked_in(canvas, corner, end, is_yellow));
      };
      const double near = 40;
      EXPECT_EQ(letter_in({width - near, middle_y - near}, {width, middle_y + near}), side_of(right));
      EXPECT_EQ(letter_in({0, middle_y - near}, {near, middle_y + near}), side_of(-right));
      EXPECT_EQ(letter_in({middle_x - near, height - near}, {middle_x + near, height}), side_of(down));
      EXPECT_EQ(letter_in({middle_x - near, title_height}, {middle_x + near, title_height + near}), side_of(-down));
    }
  }
}

/// A force's arrow begins at its place, points where the force does, and is for 1 N as long as the scale "1 N".
TEST(SlicePicture, AnArrowPointsWhereTheForceDoes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int n = 0; n < 40; ++n) {
    SliceView view;
    view.center_mm = {10 * number(random), 10 * number(random), 10 * number(random)};
    view.right = glm::normalize(glm::dvec3(number(random), number(random), number(random)));
    view.down = glm::normalize(glm::cross(view.right, glm::dvec3(number(random), number(random), number(random))));
    view.extent_mm = 120 + 20 * number(random);
    const double turn = 3.2 * number(random), strength_n = 1.25 + 0.75 * number(random);
    const Point forward(std::cos(turn), std::sin(turn));
    const ForceArrow arrow{.at_mm = view.center_mm,
                           .force_n = strength_n * (forward.x * view.right + forward.y * view.down)};
    const Canvas canvas = draw_slice(NothingScanned(), view, {}, {&arrow, 1}, "", slice_width, slice_height);
    const double scales = slice_height - 45.0;  // below: the scales
    const Marked drawn = marked_in(canvas, {0, 0}, {slice_width, scales}, is_green);
    const Marked scale = marked_in(canvas, {0, scales}, {slice_width, slice_height}, is_green);
    ASSERT_FALSE(drawn.pixels.empty());
    ASSERT_FALSE(scale.pixels.empty());
    const Point begin(slice_width / 2.0, (slice_height + title_height) / 2.0);
    double first = 0, last = 0;
    for (const auto& [column, row] : drawn.pixels) {
      const Point from = Point(column + 0.5, row + 0.5) - begin;
      first = std::min(first, glm::dot(from, forward));
      last = std::max(last, glm::dot(from, forward));
    }
    EXPECT_GT(first, -4);
    EXPECT_NEAR(last, strength_n * scale.width(), 3 + 2 * strength_n);
  }
}

/// The bar that says 10 mm is as long as 10 mm of the slice.
TEST(SlicePicture, TheBarIsAsLongAsItSays) {
  for (const double extent_mm : {40.0, 60.0, 100.0, 150.0}) {
    SliceView view;
    view.extent_mm = extent_mm;
    const Canvas canvas = draw_slice(NothingScanned(), view, {}, {}, "", slice_width, slice_height);
    const double bar = slice_height - 20.0;  // below the words
    const Marked white = marked_in(canvas, {0, bar}, {slice_width / 2.0 - 30, slice_height}, is_white);
    ASSERT_FALSE(white.pixels.empty());
    EXPECT_NEAR(white.width(), 10 * slice_width / extent_mm, 4) << extent_mm;
    // It is level: its beginning is as high as its end.
    const double quarter = white.width() / 4.0, begin = white.left, end = white.right + 1;
    const Marked first = marked_in(canvas, {begin, bar}, {begin + quarter, slice_height}, is_white);
    const Marked last = marked_in(canvas, {end - quarter, bar}, {end, slice_height}, is_white);
    EXPECT_EQ(first.top, last.top) << extent_mm;
    EXPECT_EQ(first.bottom, last.bottom) << extent_mm;
  }
}

/// A track's words stand right of its line, whole; those of the scales begin where the scale does.
TEST(SlicePicture, WordsStandBesideWhatTheyName) {
  const Track track{"HHHH", {}, colors::orange, 2};
  const Canvas canvas = draw_slice(NothingScanned(), {}, {&track, 1}, {}, "", slice_width, slice_height);
  const Marked words = marked_in(canvas, {0, title_height + 8}, {slice_width / 2.0, title_height + 30}, is_white);
  ASSERT_FALSE(words.pixels.empty());
  EXPECT_GE(words.left, 46);
  EXPECT_LE(words.left, 54);
  const Marked scale =
      marked_in(canvas, {0, slice_height - 40.0}, {slice_width / 2.0 - 30, slice_height - 22.0}, is_white);
  ASSERT_FALSE(scale.pixels.empty());
  EXPECT_NEAR(scale.left, 21, 4);
}

}  // namespace
}  // namespace palpate::plugin
