#include "plugin/report/mark_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/load.h"
#include "io/series.h"
#include "plugin/report/mark_results.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"
#include "testdata/write_series.h"

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

/// In HU black is -600 and white is 800, so that lung, soft tissue and bone are told apart in every picture.
TEST(MarkPictures, HounsfieldUnitsAreShownFromLungToBone) {
  for (const double value : {-900.0, -450.0, 0.0, 300.0, 650.0, 900.0}) {
    const auto volume = std::make_shared<const io::Volume>(
        testdata::scan(testdata::make_sphere(20, value), testdata::make_geometry({.size = glm::ivec3(50)})));
    Marks marks;
    marks.points.push_back({.name = "Mark 1"});
    const io::Picture picture = pictures_of(marks, volume).at(0);
    const int at = 3 * ((picture.rows / 2 + 37) * picture.columns + picture.columns / 2 + 20);
    const double wanted = 255 * std::clamp((value + 600) / 1400, 0.0, 1.0);
    EXPECT_NEAR(picture.pixels[static_cast<std::size_t>(at)], wanted, 3) << value;
  }
}

/// A picture's description says which mark it shows and where that is: x, y and z in this order.
TEST(MarkPictures, TheDescriptionSaysWhereTheMarkIs) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = glm::ivec3(50)})));
  Marks marks;
  marks.points.push_back({.name = "Mark 1", .position_mm = {1, -2.5, 3}});
  marks.points.push_back({.name = "Mark 2", .position_mm = {-12.25, 7, 0.5}});
  const std::vector<io::Picture> pictures = pictures_of(marks, volume);
  ASSERT_EQ(pictures.size(), 2U);
  EXPECT_EQ(pictures[0].description, "Mark 1: 1.0, -2.5, 3.0 mm (LPS)");
  EXPECT_EQ(pictures[1].description, "Mark 2: -12.2, 7.0, 0.5 mm (LPS)");
}

/// What is written is named: the report first, and then a picture for each mark.
TEST(MarkPictures, TheFilesOfTheResultsAreTheReportAndAPictureForEachMark) {
  const auto scan = testing::fresh_path("marked_scan");
  testdata::write_series(testdata::scan(testdata::make_sphere(6), testdata::make_geometry({.size = glm::ivec3(12)})),
                         scan);
  const io::Series series = io::find_series(std::array{scan}).series.at(0);
  const auto volume = std::make_shared<const io::Volume>(io::load(series));
  for (const std::size_t count : {1U, 3U}) {
    Marks marks;
    for (std::size_t n = 0; n < count; ++n) marks.points.push_back({.name = "Mark " + std::to_string(n + 1)});
    const auto folder = testing::fresh_path("results_of_" + std::to_string(count));
    std::filesystem::create_directory(folder);
    const auto files = write_results(series, volume, marks, folder);
    ASSERT_EQ(files.size(), 1 + count);
    EXPECT_EQ(files[0], folder / "measurements.dcm");
    for (std::size_t n = 0; n < files.size(); ++n) {
      EXPECT_TRUE(std::filesystem::is_regular_file(files[n])) << files[n];
      if (n > 0) {
        EXPECT_TRUE(files[n].filename().string().starts_with("picture")) << files[n];
      }
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
