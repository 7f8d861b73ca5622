#include "io/archive/testing/orthanc_test_case.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include <cstdlib>

#include "io/errors.h"

namespace palpate::io::testing {
namespace {

namespace fs = std::filesystem;

std::string text(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  item.findAndGetOFString(key, value);
  return value.c_str();
}

}  // namespace

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

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const ArchiveError& error) {
    return error.what();
  }
  return "no refusal";
}

void OrthancTest::fill(const std::string& series) {
  // -xs offers JPEG Lossless, -xf only the options given; the default is uncompressed.
  const std::string command = "storescu -aet PALPATE -aec ORTHANC " + std::string(series == compressed ? "-xs " : "") +
                              "+sd +r 127.0.0.1 " + std::to_string(archive().port) + " " +
                              (made_series() / series).string();
  ASSERT_EQ(std::system((command + " >/dev/null 2>&1").c_str()), 0) << command;
}

void OrthancTest::SetUpTestSuite() {
  if (orthanc_program().empty()) return;
  scratch_.reset(new FreshFolder(temporary_folder()));
  plain_ = std::make_unique<Orthanc>(scratch_->path() / "plain");
  for (const std::string& series : {ct, compressed, brain}) fill(series);
}

void OrthancTest::TearDownTestSuite() {
  secure_.reset();
  plain_.reset();
  scratch_.reset();
}

void OrthancTest::SetUp() {
  if (orthanc_program().empty()) GTEST_SKIP() << "Orthanc is not installed: apt-get install orthanc";
}

void OrthancTest::expect_same(const std::string& series, const fs::path& fetched) {
  const auto wanted = instances(made_series() / series), got = instances(fetched);
  ASSERT_EQ(got.size(), wanted.size());
  for (const auto& [uid, one] : wanted) {
    ASSERT_TRUE(got.contains(uid)) << uid;
    EXPECT_EQ(got.at(uid).series, one.series);
    EXPECT_TRUE(got.at(uid).pixels == one.pixels) << "pixels of " << uid;
  }
}

}  // namespace palpate::io::testing
