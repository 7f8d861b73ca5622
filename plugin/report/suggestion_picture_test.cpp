#include "plugin/report/suggestion_picture.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "modes/scene/suggest.h"
#include "modes/testing/test_rig.h"
#include "plugin/report/canvas.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// The middle of what is white in a stretch of a picture's columns, pixels.
Point white_middle(const std::filesystem::path& file, int first_column, int last_column) {
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image(
      cairo_image_surface_create_from_png(file.c_str()), cairo_surface_destroy);
  const unsigned char* const data = cairo_image_surface_get_data(image.get());
  const int stride = cairo_image_surface_get_stride(image.get());
  Point sum(0);
  int count = 0;
  for (int row = 40; row < 560; ++row) {  // the slices: 520 pixels square below a line of text
    for (int column = first_column; column < last_column; ++column) {
      if (data[row * stride + 4 * column] < 150) continue;
      sum += Point(column, row);
      ++count;
    }
  }
  EXPECT_GT(count, 20);
  return sum / static_cast<double>(count);
}

/// As radiologists hang them: on the axial slice the patient's left is at the right and the back below, on the sagittal
/// one the back is at the right and the head above. A small ball tells where it lies.
TEST(SuggestionPicture, SlicesHangAsRadiologistsHangThem) {
  modes::Suggestion suggestion;
  suggestion.scene = modes::testing::scene_of({modes::testing::surface(modes::TransferFunction(0.0))});
  suggestion.typical = {-1000, 200};
  const auto picture_of_ball = [&](const glm::dvec3& center_mm) {
    testdata::Phantom ball = testdata::make_sphere(6, 300);
    ball.bodies.front().shape = testdata::Ball{.center = center_mm, .radius = 6};
    const auto volume =
        std::make_shared<const io::Volume>(testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(60)})));
    auto file = testing::fresh_path("suggestion.png");
    write_suggestion_png(suggestion, volume, file);
    return file;
  };
  // 520 pixels for 60 mm, 16 from the edge and between the slices.
  constexpr double per_mm = 520 / 60.0, middle_row = 40 + 260, axial = 16 + 260, sagittal = 16 + 520 + 16 + 260;
  for (const double a : {-15.0, 15.0}) {
    for (const double b : {-12.0, 12.0}) {
      const Point across = white_middle(picture_of_ball({a, b, 0}), 16, 536);
      EXPECT_NEAR(across.x, axial + per_mm * a, 12);
      EXPECT_NEAR(across.y, middle_row + per_mm * b, 12);
      const Point along = white_middle(picture_of_ball({0, a, b}), 552, 1072);
      EXPECT_NEAR(along.x, sagittal + per_mm * a, 12);
      EXPECT_NEAR(along.y, middle_row - per_mm * b, 12);
    }
  }
}

/// The boundary's color lies where the ball's surface is, and nowhere else.
TEST(SuggestionPicture, ShowsABoundaryWhereItIsInTheScan) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(22), testdata::make_geometry({.size = glm::ivec3(60)}), {.noise = 10}));
  const modes::Suggestion found = modes::suggest(volume);
  ASSERT_EQ(found.boundaries.size(), 1U);
  const auto file = testing::fresh_path("suggestion.png");
  write_suggestion_png(found, volume, file);
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image(
      cairo_image_surface_create_from_png(file.c_str()), cairo_surface_destroy);
  const unsigned char* const data = cairo_image_surface_get_data(image.get());
  const int stride = cairo_image_surface_get_stride(image.get());
  constexpr double per_mm = 520 / 60.0;
  for (const Point middle : {Point(16 + 260, 40 + 260), Point(16 + 520 + 16 + 260, 40 + 260)}) {
    int on_surface = 0, colored = 0, just_inside = 0, missing = 0;
    for (int row = 40; row < 560; ++row) {
      for (int column = static_cast<int>(middle.x) - 258; column < middle.x + 258; ++column) {
        const unsigned char* const bgr = data + row * stride + 4 * column;
        const double beyond = glm::length(Point(column, row) - middle) / per_mm - 22;
        const bool is_colored = std::abs(bgr[2] - bgr[0]) >= 40;
        if (beyond > -2 && beyond < -1) {
          ++just_inside;
          missing += is_colored ? 0 : 1;
        }
        if (!is_colored) continue;
        ++colored;
        // It sets in at the surface, and ends where the gradient is 0.08 of its peak: 2.25 sigma of 2 mm inside.
        on_surface += beyond > -6 && beyond < 1.5;
      }
    }
    EXPECT_GT(colored, 0.5 * 2 * 3.1 * 22 * per_mm * per_mm);
    EXPECT_GT(on_surface, 0.99 * colored);
    EXPECT_GT(just_inside, 5000);
    EXPECT_LT(missing, 0.01 * just_inside) << "all around it";
  }
}

/// A picture of pixels in memory.
class Pictured {
 public:
  explicit Pictured(const std::filesystem::path& file)
      : image_(cairo_image_surface_create_from_png(file.c_str()), cairo_surface_destroy) {}
  /// Red, green and blue.
  std::array<int, 3> at(int column, int row) const {
    const unsigned char* const bgr =
        cairo_image_surface_get_data(image_.get()) + row * cairo_image_surface_get_stride(image_.get()) + 4 * column;
    return {bgr[2], bgr[1], bgr[0]};
  }
  int columns() const { return cairo_image_surface_get_width(image_.get()); }
  bool is_dark(int column, int row) const { return at(column, row)[0] < 110; }
  /// Dark pixels in a part of the picture.
  int dark_in(int left, int right, int top, int bottom) const {
    int count = 0;
    for (int row = top; row < bottom; ++row) {
      for (int column = left; column < right; ++column) count += is_dark(column, row) ? 1 : 0;
    }
    return count;
  }

 private:
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image_;
};

/// Beside the slices is the histogram with a disc for each boundary, at the values of its two tissues; each picture has
/// its title, each axis its name and a number for each tissue, each boundary its color below.
TEST(SuggestionPicture, ShowsBetweenWhichValuesTheBoundariesLie) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(8), testdata::make_geometry({.size = glm::ivec3(20)})));
  modes::Suggestion suggestion;
  suggestion.scene = modes::testing::scene_of(
      {modes::testing::surface(modes::TransferFunction(0.0)), modes::testing::surface(modes::TransferFunction(0.0))});
  suggestion.scene.modes[0].color = "#ff0000";
  suggestion.scene.modes[1].color = "#0000ff";
  suggestion.typical = {100, 500, 800, 300};
  suggestion.typical.pop_back();
  suggestion.boundaries = {{.mode = 0, .low = 0, .high = 1, .share = 0.75}, {.mode = 1, .low = 1, .high = 2}};
  suggestion.edges.values = {.low = 0, .high = 1000, .count = 192};
  suggestion.edges.counts.assign(192 * 192, 0);
  suggestion.edges.counts[57 * 192 + 38] = 9;  // low at 200, high at 300
  const auto file = testing::fresh_path("pairs.png");
  write_suggestion_png(suggestion, volume, file);
  const Pictured picture(file);
  constexpr int left = 1190, top = 40, side = 520;
  const auto column_of = [](double value) { return left + static_cast<int>(side * value / 1000); };
  const auto row_of = [](double value) { return top + side - static_cast<int>(side * value / 1000); };
  EXPECT_EQ(picture.at(column_of(100), row_of(500)), (std::array{255, 0, 0}));
  EXPECT_EQ(picture.at(column_of(500), row_of(800)), (std::array{0, 0, 255}));
  EXPECT_EQ(picture.at(column_of(500), row_of(500)), (std::array{255, 255, 255}));
  EXPECT_LT(picture.at(column_of(200), row_of(300))[0], 60) << "counted";
  EXPECT_EQ(picture.at(column_of(300), row_of(200)), (std::array{255, 255, 255})) << "not the other way round";
  // Titles above the three, and nothing of them in the histogram.
  for (const int begin : {16, 552, left}) EXPECT_GT(picture.dark_in(begin, begin + 100, 20, 36), 60) << begin;
  EXPECT_EQ(picture.dark_in(left + 10, left + 300, top + 1, top + 20), 0);
  // The axes' names, left of the histogram and below it.
  EXPECT_GT(picture.dark_in(1088, 1110, top + 150, top + 370), 100);
  EXPECT_GT(picture.dark_in(left + 100, left + 420, top + side + 36, top + side + 56), 100);
  // Three numbers below it, each under its value.
  std::vector<int> numbers;
  for (int column = left - 30; column < left + side + 30; ++column) {
    if (picture.dark_in(column, column + 1, top + side + 5, top + side + 32) == 0) continue;
    if (numbers.empty() || column > numbers.back() + 40) numbers.push_back(column);
  }
  ASSERT_EQ(numbers.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(numbers[n] + 11, column_of(suggestion.typical[n]), 5);
  // Below, between the colors of two boundaries, it is white.
  const int first = top + side + 2 * 16 + 8 - 12;
  EXPECT_EQ(picture.at(30, first + 7), (std::array{255, 0, 0}));
  EXPECT_EQ(picture.at(30, first + 22 + 7), (std::array{0, 0, 255}));
  EXPECT_EQ(picture.at(30, first + 18), (std::array{255, 255, 255}));
}

modes::Suggestion suggestion_of(const std::vector<double>& typical) {
  modes::Suggestion suggestion;
  suggestion.scene = modes::testing::scene_of({modes::testing::surface(modes::TransferFunction(0.0))});
  suggestion.typical = typical;
  suggestion.edges.values = {.low = 0, .high = 1000, .count = 192};
  suggestion.edges.counts.assign(192 * 192, 0);
  return suggestion;
}

/// Black is the darkest tissue; three quarters of white are 1.15 times as far from it as the brightest.
TEST(SuggestionPicture, GraysAreTheValuesBetweenTheTissues) {
  const auto file = testing::fresh_path("grays.png");
  const std::vector<double> typical{-1000, 200};
  for (const double value : {-700.0, 300.0, 900.0}) {
    const auto volume = std::make_shared<const io::Volume>(
        testdata::scan(testdata::make_sphere(6, value), testdata::make_geometry({.size = glm::ivec3(20)})));
    std::filesystem::remove(file);
    write_suggestion_png(suggestion_of(typical), volume, file);
    const double wanted = 255 * 0.75 * std::min(1.0, (value - typical[0]) / (1.15 * (typical[1] - typical[0])));
    EXPECT_NEAR(Pictured(file).at(16 + 260, 40 + 260)[0], wanted, 2) << value;
  }
}

/// Numbers of similar tissues stand in two rows, those of unlike ones in one. Nothing is right of the histogram but a
/// margin.
TEST(SuggestionPicture, NumbersOfSimilarTissuesStandInTwoRows) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(6), testdata::make_geometry({.size = glm::ivec3(20)})));
  const auto file = testing::fresh_path("numbers.png");
  constexpr int left = 1190, below = 40 + 520;
  for (const double second : {320.0, 360.0, 420.0, 700.0}) {
    std::filesystem::remove(file);
    write_suggestion_png(suggestion_of({300, second}), volume, file);
    const Pictured picture(file);
    const bool is_similar = 520 * (second - 300) / 1000 < 44;
    EXPECT_GT(picture.dark_in(left + 130, left + 500, below + 5, below + 18), 0) << second;
    EXPECT_EQ(picture.dark_in(left + 130, left + 500, below + 20, below + 32) > 0, is_similar) << second;
    EXPECT_GE(picture.columns(), left + 520);
    EXPECT_LE(picture.columns(), left + 520 + 40);
  }
}

/// A dashed line at each end of a tissue, upright and level; none where a tissue has no end.
TEST(SuggestionPicture, TissuesEndsAreLinesInTheHistogram) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(6), testdata::make_geometry({.size = glm::ivec3(20)})));
  modes::Suggestion suggestion = suggestion_of({100, 800});
  suggestion.scene.tissues = {{"soft", 0, 350, 10, ""}, {"hard", 350, std::numeric_limits<double>::infinity(), 10, ""}};
  const auto file = testing::fresh_path("ends.png");
  write_suggestion_png(suggestion, volume, file);
  const Pictured picture(file);
  constexpr int left = 1190, top = 40, side = 520, end = side * 350 / 1000;
  const auto not_white = [&](bool upright, int at) {
    int count = 0;
    for (int along = 30; along < side - 30; ++along) {
      const auto color = upright ? picture.at(left + at, top + along) : picture.at(left + along, top + side - at);
      count += color[0] < 220 ? 1 : 0;
    }
    return count;
  };
  for (const bool upright : {true, false}) {
    EXPECT_GT(not_white(upright, end), 150);
    EXPECT_LT(not_white(upright, end), side - 80) << "dashed";
    EXPECT_LT(not_white(upright, end + 60), 20);
  }
}

}  // namespace
}  // namespace palpate::plugin
