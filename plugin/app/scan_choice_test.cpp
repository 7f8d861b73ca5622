// One folder with several series: names, numbers and defaults mean the same in every program.
#include "plugin/app/scan_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>

#include "io/errors.h"
#include "io/load.h"
#include "plugin/app/errors.h"
#include "plugin/options/series_option.h"
#include "plugin/testing/test_files.h"
#include "testdata/phantom.h"
#include "testdata/scan.h"
#include "testdata/write_series.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using testing::fresh_path;
using ::testing::HasSubstr;
using ::testing::Not;

io::Series volume_of(const std::string& uid, int slices, double apart_mm) {
  io::Series series;
  series.uid = uid;
  series.modality = "CT";
  series.geometry.dimensions = {16, 16, slices};
  series.geometry.spacing_i = series.geometry.spacing_j = 1;
  series.geometry.step = {0, 0, apart_mm};
  series.usable = true;
  return series;
}

/// Two volumes of one UID, a thin one, one picture that is no volume; and a velocity field.
io::Catalogue catalogue() {
  io::Catalogue all;
  all.series = {volume_of("1.2", 900, 5), volume_of("1.2", 20, 5), volume_of("1.3", 200, 1), volume_of("1.4", 1, 1)};
  all.series.back().usable = false;
  all.velocity_fields = {volume_of("1.5", 20, 2)};
  return all;
}

TEST(ScanChoice, NamesAndNumbersMeanTheSame) {
  const io::Catalogue all = catalogue();
  ASSERT_EQ(scan_count(all), 5);
  for (std::size_t n = 0; n < scan_count(all); ++n) {
    EXPECT_EQ(find_scan(all, std::to_string(n + 1)), n);
    EXPECT_EQ(find_scan(all, scan_name(all, n)), n) << scan_name(all, n);
  }
  EXPECT_EQ(scan_name(all, 1), "1.2#2");
  EXPECT_TRUE(is_velocity(all, *find_scan(all, "1.5")));
  for (const char* const none : {"0", "6", "-1", "1.2#3", "1.2#1", "1.", " 1"})
    EXPECT_FALSE(find_scan(all, none)) << none;
}

TEST(ScanChoice, FirstIsWhatShowsMostNotWhatIsLargest) {
  EXPECT_THAT(choices(catalogue(), "/absent"), ElementsAre(2, 0, 1, 3, 4));
  EXPECT_EQ(choose_scan(catalogue(), "", "/absent"), 2);
}

TEST(ScanChoice, OnlyVolumeIsNotOneOfTwo) {
  io::Catalogue all = catalogue();
  EXPECT_FALSE(only_scan(all));
  all.series = {volume_of("1.4", 1, 1), volume_of("1.3", 20, 1)};
  all.series.front().usable = false;
  EXPECT_FALSE(only_scan(all)) << "the velocity field is a choice, too";
  all.velocity_fields.clear();
  EXPECT_EQ(only_scan(all), 1);
}

TEST(ScanChoice, RefusalListsWhatCanBeNamed) {
  const io::Catalogue all = catalogue();
  try {
    choose_scan(all, "9.9", "/absent");
    FAIL() << "there is no such series";
  } catch (const io::DicomError& refused) {
    for (std::size_t n = 0; n < scan_count(all); ++n) EXPECT_THAT(refused.what(), HasSubstr(scan_name(all, n)));
  }
  EXPECT_THAT(list_scans(all, true), Not(HasSubstr("1.4")));
}

TEST(ScanChoice, TimeMeansTheNearestFrame) {
  EXPECT_EQ(frame_at(5, 2.4), 2);
  EXPECT_EQ(frame_at(5, 2.6), 3);
  EXPECT_EQ(frame_at(5, -7), 0);
  EXPECT_EQ(frame_at(5, 1e9), 4);
}

// A series whose images make two volumes: the command line names the second as ParaView's state files do.
TEST(ScanChoice, CommandLineTakesTheNameOfTheSecondVolume) {
  const auto folder = fresh_path("two_in_one");
  std::filesystem::create_directory(folder);
  for (const int size : {12, 16}) {
    testdata::write_series(
        testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(size)})),
        folder / std::to_string(size), {.number = 1, .study = "one"});
  }
  const std::array paths{folder};
  const io::Catalogue found = io::find_series(paths);
  ASSERT_EQ(found.series.size(), 2);
  const std::string& uid = found.series.front().uid;
  ASSERT_EQ(found.series.back().uid, uid);
  EXPECT_EQ(choose_series({folder.string(), uid + "#2", 0}, found).geometry.dimensions,
            found.series.back().geometry.dimensions);
  EXPECT_NE(found.series.front().geometry.dimensions, found.series.back().geometry.dimensions);
  try {
    choose_series({folder.string(), uid, 0}, found);
    FAIL() << "either may be meant";
  } catch (const WrongUsage& refused) {
    EXPECT_THAT(refused.what(), HasSubstr(uid + "#2"));
  }
}

}  // namespace
}  // namespace palpate::plugin
