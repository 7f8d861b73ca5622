// Echo and find against a real archive.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "io/archive/find.h"
#include "io/archive/testing/orthanc_test_case.h"
#include "io/archive/testing/says.h"

namespace palpate::io {
namespace {

using testing::brain;
using testing::compressed;
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::instances;
using testing::OrthancTest;
using testing::refusal;
using testing::says;
using testing::shared;
using testing::tilt;

std::string text(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  item.findAndGetOFString(key, value);
  return value.c_str();
}

TEST_F(OrthancTest, AnswersAnEcho) {
  EXPECT_NO_THROW(echo(archive()));
}

TEST_F(OrthancTest, SaysWhichTitleIsWrong) {
  Archive wrong = archive();
  wrong.called = "NOBODY";
  EXPECT_TRUE(says(refusal([&] { echo(wrong); }), "{} is not known there as {}: set --called to its own AE title"));
  wrong = archive();
  wrong.calling = "STRANGER";
  EXPECT_THAT(refusal([&] { echo(wrong); }), HasSubstr("STRANGER"));
}

TEST_F(OrthancTest, FindsWhatIsThere) {
  const auto wanted = instances(shared / brain);
  const Found all = find(archive(), {});
  EXPECT_FALSE(all.more);
  std::map<std::string, std::size_t> images;
  for (const ArchivedStudy& study : all.studies) {
    for (const ArchivedSeries& series : study.series) images[series.uid] += static_cast<std::size_t>(series.images);
  }
  std::map<std::string, std::size_t> expected;
  for (const std::string& name : {tilt, compressed, brain}) {
    for (const auto& [uid, one] : instances(shared / name)) ++expected[one.series];
  }
  EXPECT_EQ(images, expected);

  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile(fs::directory_iterator(shared / brain)->path().c_str()).good());
  const std::string date = text(*file.getDataset(), DCM_StudyDate), id = text(*file.getDataset(), DCM_PatientID);
  const std::string study = text(*file.getDataset(), DCM_StudyInstanceUID);
  ArchiveQuery query;
  query.date = date;
  query.patient_id = id;
  const Found one = find(archive(), query);
  ASSERT_EQ(one.studies.size(), 1U);
  EXPECT_EQ(one.studies.front().uid, study);
  EXPECT_EQ(one.studies.front().date, date);
  // Found without its series, which are then asked for.
  query.with_series = false;
  const Found bare = find(archive(), query);
  ASSERT_EQ(bare.studies.size(), 1U);
  EXPECT_TRUE(bare.studies.front().series.empty());
  const auto asked = find_series_of(archive(), study);
  ASSERT_EQ(asked.size(), one.studies.front().series.size());
  for (std::size_t n = 0; n < asked.size(); ++n) {
    EXPECT_EQ(asked[n].uid, one.studies.front().series[n].uid);
    EXPECT_EQ(asked[n].images, expected[asked[n].uid]);
  }
  EXPECT_TRUE(says(refusal([&] { find_series_of(archive(), "*"); }),
                   "{} is no UID: `palpate find` lists those of studies and series"));
  query.date = "19000101-19000102";
  EXPECT_TRUE(find(archive(), query).studies.empty());
  ArchiveQuery by_modality;
  by_modality.modality = "CT";
  for (const ArchivedStudy& found : find(archive(), by_modality).studies) {
    for (const ArchivedSeries& series : found.series) EXPECT_EQ(series.modality, "CT");
  }
}

TEST_F(OrthancTest, LimitsWhatAnEmptyQuestionReturns) {
  ArchiveQuery query;
  query.most_studies = 1;
  const Found found = find(archive(), query);
  EXPECT_EQ(found.studies.size(), 1U);
  EXPECT_TRUE(found.more);
  EXPECT_TRUE(says(refusal([&] {
                     ArchiveQuery bad;
                     bad.date = "yesterday";
                     find(archive(), bad);
                   }),
                   "--date has to be YYYYMMDD, YYYYMMDD-YYYYMMDD, YYYYMMDD- or -YYYYMMDD"));
}

}  // namespace
}  // namespace palpate::io
