// Fetches from a real archive, by C-MOVE and C-GET: contents, folders and limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/archive/fetch.h"
#include "io/archive/testing/orthanc_test_case.h"
#include "io/archive/testing/says.h"
#include "io/errors.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using testing::brain;
using testing::compressed;
using testing::ct;
using testing::instances;
using testing::made_series;
using testing::OrthancTest;
using testing::refusal;
using testing::says;

TEST_F(OrthancTest, FetchesASeriesByMove) {
  std::size_t told = 0;
  const Fetched fetched = fetch(archive(), {uid_of(brain)}, folder("by-move"), {}, [&](const FetchProgress& progress) {
    told = std::max(told, progress.files);
    return true;
  });
  EXPECT_TRUE(fetched.warnings.empty());
  EXPECT_EQ(fetched.files, 20U);
  ASSERT_EQ(fetched.series.size(), 1U);
  expect_same(brain, folder("by-move"));
  const auto owner_only = fs::perms::owner_all;
  EXPECT_EQ(fs::status(folder("by-move")).permissions(), owner_only);
  EXPECT_EQ(fs::status(fetched.series.front().folder).permissions(), owner_only);
  EXPECT_FALSE(testing::is_listening(archive().listen_port)) << "the storage service is closed when nothing is fetched";
}

TEST_F(OrthancTest, ListensOnlyWhileItFetches) {
  bool open = false;
  const int port = archive().listen_port;
  EXPECT_FALSE(testing::is_listening(port));
  fetch(archive(), {uid_of(brain)}, folder("listening"), {}, [&](const FetchProgress& progress) {
    open = open || (progress.files > 0 && testing::is_listening(port));
    return true;
  });
  EXPECT_TRUE(open);
  EXPECT_FALSE(testing::is_listening(port));
}

TEST_F(OrthancTest, FetchesAStudyByGet) {
  Archive by_get = archive();
  by_get.uses_get = true;
  const std::string study = instances(made_series() / ct).begin()->second.study;
  const Fetched fetched = fetch(by_get, {study}, folder("by-get"));
  EXPECT_TRUE(fetched.warnings.empty());
  expect_same(ct, folder("by-get"));
}

/// What is told while several come is of all of them, and what has come says what it is.
TEST_F(OrthancTest, FetchesSeveralSeriesAndTellsOfAllOfThem) {
  for (const bool uses_get : {false, true}) {
    Archive way = archive();
    way.uses_get = uses_get;
    std::vector<FetchProgress> told;
    const Fetched fetched =
        fetch(way, {uid_of(ct), uid_of(brain), uid_of(compressed)}, folder(uses_get ? "several-get" : "several-move"),
              {}, [&](const FetchProgress& progress) {
                told.push_back(progress);
                return true;
              });
    std::set<int> expected;
    for (const FetchProgress& one : told) expected.insert(one.expected);
    expected.erase(-1);  // as long as the archive is asked
    EXPECT_THAT(expected, ::testing::ElementsAre(4 + 20 + 4));
    EXPECT_EQ(told.back().files, 28U);
    std::map<std::string, std::string> study_of;
    for (const FetchedSeries& series : fetched.series) {
      study_of[series.uid] = series.study_uid;
      for (const auto& [uid, one] : instances(series.folder)) {
        EXPECT_EQ(one.series, series.uid);
        EXPECT_EQ(one.study, series.study_uid);
      }
    }
    EXPECT_EQ(study_of.size(), 3U);
    for (const std::string& name : {ct, brain, compressed}) {
      EXPECT_EQ(study_of[uid_of(name)], instances(made_series() / name).begin()->second.study) << name;
    }
  }
}

/// A study and a series of it, in either order, and one twice: each image is fetched once.
TEST_F(OrthancTest, FetchesWhatIsNamedTwiceOnce) {
  const std::string study = instances(made_series() / ct).begin()->second.study;
  int number = 0;
  for (const bool uses_get : {false, true}) {
    Archive way = archive();
    way.uses_get = uses_get;
    for (const auto& uids :
         std::vector<std::vector<std::string>>{{study, uid_of(ct)}, {uid_of(ct), study}, {uid_of(ct), uid_of(ct)}}) {
      const std::string name = "twice-" + std::to_string(++number);
      const Fetched fetched = fetch(way, uids, folder(name));
      EXPECT_EQ(fetched.files, 4U);
      EXPECT_TRUE(fetched.complete);
      EXPECT_TRUE(fetched.warnings.empty());
      expect_same(ct, folder(name));
    }
  }
}

TEST_F(OrthancTest, FetchesCompressedImagesAsTheyAre) {
  for (const bool uses_get : {false, true}) {
    Archive way = archive();
    way.uses_get = uses_get;
    const fs::path here = folder(uses_get ? "compressed-get" : "compressed-move");
    const Fetched fetched = fetch(way, {uid_of(compressed)}, here);
    EXPECT_EQ(fetched.files, 4U) << here;
    const auto got = instances(here);
    for (const auto& [uid, one] : instances(made_series() / compressed)) {
      ASSERT_TRUE(got.contains(uid));
      EXPECT_EQ(got.at(uid).syntax, one.syntax) << here;
    }
  }
}

TEST_F(OrthancTest, FetchesTwiceIntoOneFolder) {
  fetch(archive(), {uid_of(ct)}, folder("twice"));
  const Fetched again = fetch(archive(), {uid_of(ct)}, folder("twice"));
  EXPECT_EQ(again.series.front().folder.filename(), "series-002");
}

TEST_F(OrthancTest, SaysWhatItDoesNotHold) {
  EXPECT_TRUE(says(refusal([&] { fetch(archive(), {"1.2.3.4.5"}, folder("absent")); }),
                   "archive {} holds no study and no series {}: `palpate find` lists what it holds"));
  EXPECT_FALSE(fs::exists(folder("absent"))) << "nothing is left of it";
  EXPECT_TRUE(says(refusal([&] { fetch(archive(), {"../etc"}, folder("absent")); }),
                   "{} is no UID: `palpate find` lists those of studies and series"));
}

TEST_F(OrthancTest, LeavesNothingOfACanceledFetch) {
  for (const bool uses_get : {false, true}) {
    Archive way = archive();
    way.uses_get = uses_get;
    EXPECT_THROW(fetch(way, {uid_of(brain)}, folder("canceled"), {},
                       [](const FetchProgress& progress) { return progress.files < 1; }),
                 Cancelled);
    EXPECT_FALSE(fs::exists(folder("canceled")));
    EXPECT_FALSE(testing::is_listening(archive().listen_port));
  }
}

TEST_F(OrthancTest, StaysUnderItsLimits) {
  FetchLimits few;
  few.files = 3;
  EXPECT_EQ(refusal([&] { fetch(archive(), {uid_of(brain)}, folder("few"), few); }),
            "more than 3 files came: fetch series by series, or allow more with --most-files");
  EXPECT_FALSE(fs::exists(folder("few")));
  FetchLimits small;
  small.bytes = 1U << 20U;
  EXPECT_EQ(refusal([&] { fetch(archive(), {uid_of(brain)}, folder("small"), small); }),
            "more than 1 MiB came: fetch series by series, or allow more with --most-mib");
  EXPECT_FALSE(fs::exists(folder("small")));
}

TEST_F(OrthancTest, SaysWhenItsPortIsTaken) {
  Archive taken = archive();
  taken.listen_port = taken.port;  // the archive itself listens there
  taken.listen_address = "0.0.0.0";
  EXPECT_TRUE(says(refusal([&] { fetch(taken, {uid_of(ct)}, folder("taken")); }),
                   "cannot listen on {}:{} for what archive {} sends ({}): set another address or port with "
                   "--listen-address and --listen, and have it entered in the archive"));
}

TEST_F(OrthancTest, ListensOnAnAddressOfThisMachine) {
  Archive elsewhere = archive();
  elsewhere.listen_address = "everywhere";
  EXPECT_TRUE(says(refusal([&] { fetch(elsewhere, {uid_of(ct)}, folder("elsewhere")); }), "no IPv4 address"));
}

}  // namespace
}  // namespace palpate::io
