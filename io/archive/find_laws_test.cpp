// Search results have a fixed order and texts, whatever the order of the archive's answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/archive/find.h"
#include "io/archive/testing/odd_archive.h"

namespace palpate::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::OddArchive;

std::string words_of(const ArchivedSeries& series) {
  return std::to_string(series.number) + ": " + series.description + ", " + std::to_string(series.images);
}

std::vector<std::string> words_of(const std::vector<ArchivedSeries>& all) {
  std::vector<std::string> words;
  for (const ArchivedSeries& series : all) words.push_back(words_of(series));
  return words;
}

TEST(FindLaws, TheLatestStudyIsTheFirst) {
  OddArchive odd("several");
  ArchiveQuery query;
  query.with_series = false;
  std::vector<std::string> studies;
  for (const ArchivedStudy& study : find(odd.archive(), query).studies) {
    studies.push_back(study.date + " " + study.uid + " " + study.description);
  }
  EXPECT_THAT(studies, ElementsAre("20240115 1.2.3.2 Thin slices", "20231231 1.2.3.3 Thick slices",
                                   "20210301 1.2.3.1 Localizer"));
}

// Found with their study or asked for alone.
TEST(FindLaws, SeriesAreInTheOrderOfTheirNumbersAndHaveTheirDescriptions) {
  const auto wanted = ElementsAre("1: Thin slices, 7", "3: Thick slices, 40", "20: Localizer, 5");
  OddArchive odd("several");
  const Found found = find(odd.archive(), {});
  ASSERT_EQ(found.studies.size(), 3U);
  for (const ArchivedStudy& study : found.studies) {
    EXPECT_THAT(words_of(study.series), wanted);
    EXPECT_EQ(study.series.at(0).uid, study.uid + ".2");
  }
  EXPECT_THAT(words_of(find_series_of(odd.archive(), "1.2.3.1")), wanted);
}

/// What cannot be asked is refused before the archive is called; what can be asked is not.
TEST(FindLaws, DatesAndUidsAreThoseOfTheStandard) {
  const Archive nobody{.name = "nobody", .host = "127.0.0.1", .port = 1, .called = "A", .calling = "B"};
  const auto refusal = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const ArchiveError& error) {
      return error.what();
    }
    return "";
  };
  const auto of_date = [&](const std::string& date) { return refusal([&] { find(nobody, {.date = date}); }); };
  const auto of_uid = [&](const std::string& uid) {
    const std::string as_study = refusal([&] { find_series_of(nobody, uid); });
    EXPECT_EQ(refusal([&] { find_uid(nobody, uid); }), as_study);
    return as_study;
  };
  const std::string calls = of_date("");
  ASSERT_THAT(calls, HasSubstr("nobody"));
  for (const std::string good : {"20200103", "20200103-20200109", "20200103-", "-20200103"}) {
    EXPECT_EQ(of_date(good), calls) << good;
  }
  for (const std::string bad : {"-", "2020010", "202001033", "2020010x", "x0200103", "20200103-2020010",
                                "2020-20200103", "20200103-2020010y", "20200103-20200104-", "yesterday"}) {
    EXPECT_THAT(of_date(bad), HasSubstr("YYYYMMDD")) << bad;
  }
  for (const std::string& good : {std::string("1"), std::string("1.2.840.10008"), "1." + std::string(62, '9')}) {
    EXPECT_EQ(of_uid(good), calls) << good;
  }
  for (const std::string& bad :
       {std::string(), std::string("1.2a"), std::string("*"), std::string("1.2 "), "1." + std::string(63, '9')}) {
    EXPECT_THAT(of_uid(bad), HasSubstr("is no UID")) << bad;
  }
}

}  // namespace
}  // namespace palpate::io
