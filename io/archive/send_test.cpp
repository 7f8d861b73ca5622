// Sends to a real archive, and checks the result with DCMTK's own program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/archive/send.h"
#include "io/archive/testing/orthanc_test_case.h"
#include "io/archive/testing/says.h"
#include "io/errors.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using testing::another_ct;
using testing::another_mr;
using testing::instances;
using testing::made_series;
using testing::OrthancTest;
using testing::says;

/// Whether DCMTK's own program finds so many images of the series there. What it says goes to `said`.
bool has(const Archive& archive, const std::string& series, std::size_t count, const fs::path& said) {
  const std::string command =
      "findscu -aet PALPATE -aec ORTHANC -S -k QueryRetrieveLevel=SERIES -k StudyInstanceUID -k "
      "SeriesInstanceUID=" +
      instances(made_series() / series).begin()->second.series + " -k NumberOfSeriesRelatedInstances 127.0.0.1 " +
      std::to_string(archive.port) + " > " + said.string() + " 2>&1";
  return std::system(command.c_str()) == 0 &&
         std::system(("grep -q '\\[" + std::to_string(count) + " *\\]' " + said.string()).c_str()) == 0;
}

TEST_F(OrthancTest, TakesWhatIsSent) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(made_series() / another_mr)) files.push_back(entry.path());
  files.push_back(folder("notes.txt"));
  std::ofstream(files.back()) << "not an image";
  const Sent sent = send(archive(), files);
  EXPECT_EQ(sent.files, files.size() - 1);
  ASSERT_EQ(sent.not_sent.size(), 1U);
  EXPECT_TRUE(says(sent.not_sent.front().why, "not a DICOM file that can be sent"));
  EXPECT_TRUE(has(archive(), another_mr, sent.files, folder("found")));
}

/// One class of images, as they are and compressed: each syntax is proposed, so that each file goes as it is.
TEST_F(OrthancTest, TakesFilesOfOneClassInSeveralSyntaxes) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(made_series() / another_mr)) files.push_back(entry.path());
  ASSERT_GE(files.size(), 3U);
  const fs::path compressed = folder("compressed.dcm");
  ASSERT_EQ(std::system(("dcmcrle " + files[1].string() + " " + compressed.string()).c_str()), 0);
  for (const std::vector<fs::path>& sent : {std::vector{files[0], compressed}, {compressed, files[0], files[2]}}) {
    const Sent taken = send(archive(), sent);
    EXPECT_EQ(taken.files, sent.size());
    EXPECT_TRUE(taken.not_sent.empty());
  }
}

/// Nothing is asked of an archive where there is nothing to send: each file has its reason.
TEST(Send, WithoutAnImageSaysWhyAndConnectsToNobody) {
  Archive nobody;
  nobody.name = "nobody";
  nobody.host = "127.0.0.1";
  nobody.port = 1;
  EXPECT_EQ(send(nobody, {}).files, 0U);
  const fs::path notes = fs::path(::testing::TempDir()) / "palpate-notes.txt";
  std::ofstream(notes) << "not an image";
  const Sent sent = send(nobody, {notes, notes});
  EXPECT_EQ(sent.files, 0U);
  ASSERT_EQ(sent.not_sent.size(), 2U);
  EXPECT_EQ(sent.not_sent.front().file, notes);
  EXPECT_TRUE(says(sent.not_sent.front().why, "not a DICOM file that can be sent"));
  fs::remove(notes);
}

// What it has taken by then stays there, and no more comes.
TEST_F(OrthancTest, KeepsWhatWasSentBeforeACancel) {
  const std::string& name = another_ct;  // no other test sends it
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(made_series() / name)) files.push_back(entry.path());
  ASSERT_EQ(files.size(), 4U);
  EXPECT_THROW(send(archive(), files, [](std::size_t done) { return done < 2; }), Cancelled);
  EXPECT_TRUE(has(archive(), name, 2, folder("canceled")));
  EXPECT_EQ(send(archive(), files).files, 4U);
  EXPECT_TRUE(has(archive(), name, 4, folder("sent-again")));
}

}  // namespace
}  // namespace palpate::io
