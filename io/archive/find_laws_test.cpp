// What is found has an order and words of its own, in whatever order the archive answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/archive/find.h"
#include "io/archive/testing/odd_archive.h"

namespace palpate::io {
namespace {

using ::testing::ElementsAre;
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

}  // namespace
}  // namespace palpate::io
