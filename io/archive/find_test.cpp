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
using testing::ct;
using ::testing::HasSubstr;
using testing::Instance;
using testing::instances;
using testing::made_series;
using testing::OrthancTest;
using testing::refusal;
using testing::says;

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
  const auto wanted = instances(made_series() / brain);
  const Found all = find(archive(), {});
  EXPECT_FALSE(all.more);
  std::map<std::string, std::size_t> images;
  for (const ArchivedStudy& study : all.studies) {
    for (const ArchivedSeries& series : study.series) images[series.uid] += static_cast<std::size_t>(series.images);
  }
  std::map<std::string, std::size_t> expected;
  for (const std::string& name : {ct, compressed, brain}) {
    for (const auto& [uid, one] : instances(made_series() / name)) ++expected[one.series];
  }
  EXPECT_EQ(images, expected);

  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile(fs::directory_iterator(made_series() / brain)->path().c_str()).good());
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

/// Whatever is asked for by itself, or in part, is looked for, and nothing else is found.
TEST_F(OrthancTest, FindsByEachPartOfAQuestion) {
  const Instance third = instances(made_series() / brain).begin()->second;
  const auto expect_third = [&](const char* what, const ArchiveQuery& query) {
    const Found found = find(archive(), query);
    ASSERT_EQ(found.studies.size(), 1U) << what;
    EXPECT_EQ(found.studies.front().uid, third.study) << what;
    EXPECT_EQ(found.studies.front().patient, "Generated^N3");
    EXPECT_EQ(found.studies.front().patient_id, "P3");
    EXPECT_EQ(found.studies.front().date, "20200103");
    EXPECT_EQ(found.studies.front().description, "Study of N3");
    ASSERT_EQ(found.studies.front().series.size(), 1U);
    EXPECT_EQ(found.studies.front().series.front().uid, third.series);
    EXPECT_EQ(found.studies.front().series.front().images, 20);
    EXPECT_EQ(found.studies.front().series.front().modality, "MR");
  };
  ArchiveQuery query;
  query.patient = "N3";
  expect_third("part of a name", query);
  query = {};
  query.patient_id = "P3";
  expect_third("a patient's number", query);
  query = {};
  query.date = "20200103-20200103";
  expect_third("days", query);
  query = {};
  query.description = "of N3";
  expect_third("part of a description", query);
  query = {};
  query.modality = "CT";
  const Found of_ct = find(archive(), query);
  EXPECT_FALSE(of_ct.studies.empty());
  for (const ArchivedStudy& study : of_ct.studies) EXPECT_NE(study.uid, third.study);
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
