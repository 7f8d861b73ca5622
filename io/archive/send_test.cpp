// Send to a real archive: what DCMTK's own program then finds there.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "io/archive/send.h"
#include "io/archive/testing/orthanc_test_case.h"
#include "io/archive/testing/says.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using testing::instances;
using testing::OrthancTest;
using testing::says;
using testing::shared;

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

}  // namespace
}  // namespace palpate::io
