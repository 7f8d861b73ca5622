#include "plugin/report/mark_pictures.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// A cross in yellow on a slice in gray: red, green and blue in this order, with nothing bluer than it is red but the
/// letters' smoothed edges.
TEST(MarkPictures, TheCrossIsYellow) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = glm::ivec3(50)})));
  Marks marks;
  marks.points.push_back({.name = "Mark 1", .position_mm = {1, 2, 3}});
  const std::vector<io::Picture> pictures = pictures_of(marks, volume);
  ASSERT_EQ(pictures.size(), 1U);
  const auto& pixels = pictures[0].pixels;
  int yellow = 0, cyan = 0;
  for (std::size_t n = 0; n + 2 < pixels.size(); n += 3) {
    if (pixels[n] > 200 && pixels[n + 1] > 190 && pixels[n + 2] < 110) ++yellow;
    if (pixels[n] < 110 && pixels[n + 1] > 190 && pixels[n + 2] > 200) ++cyan;
  }
  EXPECT_GT(yellow, 50);
  EXPECT_EQ(cyan, 0);
}

/// Without an absolute scale the least value of the scan is black and the largest one white.
TEST(MarkPictures, ValuesWithoutAUnitAreShownFromTheLeastToTheLargest) {
  io::Volume scanned =
      testdata::scan(testdata::make_sphere(20, 300), testdata::make_geometry({.size = glm::ivec3(50)}));
  scanned.unit.clear();
  const auto volume = std::make_shared<const io::Volume>(std::move(scanned));
  for (const auto& [middle_mm, wanted] : {std::pair{glm::dvec3(0), 255}, std::pair{glm::dvec3(0, 0, 24), 0}}) {
    Marks marks;
    marks.points.push_back({.name = "Mark 1", .position_mm = middle_mm});
    const io::Picture picture = pictures_of(marks, volume).at(0);
    // Beside the cross, nearer to it than any label is.
    const int at = 3 * ((picture.rows / 2 + 37) * picture.columns + picture.columns / 2 + 20);
    EXPECT_NEAR(picture.pixels[static_cast<std::size_t>(at)], wanted, 3);
  }
}

}  // namespace
}  // namespace palpate::plugin
