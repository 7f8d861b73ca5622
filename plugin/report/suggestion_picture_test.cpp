#include "plugin/report/suggestion_picture.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/geometric.hpp>
#include <memory>

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
    int on_surface = 0, colored = 0;
    for (int row = 40; row < 560; ++row) {
      for (int column = static_cast<int>(middle.x) - 258; column < middle.x + 258; ++column) {
        const unsigned char* const bgr = data + row * stride + 4 * column;
        if (std::abs(bgr[2] - bgr[0]) < 40) continue;
        ++colored;
        // It sets in at the surface, and ends where the gradient is 0.08 of its peak: 2.25 sigma of 2 mm inside.
        const double beyond = glm::length(Point(column, row) - middle) / per_mm - 22;
        on_surface += beyond > -6 && beyond < 1.5;
      }
    }
    EXPECT_GT(colored, 0.5 * 2 * 3.1 * 22 * per_mm * per_mm);
    EXPECT_GT(on_surface, 0.99 * colored);
  }
}

}  // namespace
}  // namespace palpate::plugin
