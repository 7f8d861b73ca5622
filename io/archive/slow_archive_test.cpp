// Archives on a slow connection: an object may take longer than the allowed silence, as long as pieces of it keep
// coming.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <vector>

#include "io/archive/fetch.h"
#include "io/archive/send.h"
#include "io/archive/testing/odd_archive.h"
#include "io/fresh_folder.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using testing::OddArchive;

constexpr int silence_s = 3;  // both objects take 5 s

TEST(SlowArchive, SendsAnImageThatTakesLongerThanTheSilence) {
  OddArchive odd("sends-slowly");
  odd.archive().uses_get = false;
  odd.archive().silence_s = silence_s;
  EXPECT_EQ(fetch(odd.archive(), {"1.2.3"}, odd.folder()).files, 1U);
}

/// Anyone may connect to the port that images come to. One who has not asked for an association after 10 s is let go,
/// though he goes on to send bytes, and the images come.
TEST(SlowArchive, OneWhoAsksTooSlowlyIsLetGo) {
  OddArchive odd("calls-hesitantly-first");
  odd.archive().uses_get = false;
  odd.archive().silence_s = 30;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(fetch(odd.archive(), {"1.2.3"}, odd.folder()).files, 1U);
  EXPECT_GT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(9));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(25)) << "5 s of them for the image";
}

TEST(SlowArchive, TakesAFileThatTakesLongerThanTheSilence) {
  const FreshFolder folder = temporary_folder();
  const fs::path file = folder.path() / "large.dcm";
  DcmFileFormat format;
  DcmDataset& dataset = *format.getDataset();
  dataset.putAndInsertString(DCM_SOPClassUID, UID_CTImageStorage);
  dataset.putAndInsertString(DCM_SOPInstanceUID, "1.2.3.4");
  const std::vector<Uint16> pixels(16U << 20U);
  dataset.putAndInsertUint16Array(DCM_PixelData, pixels.data(), pixels.size());
  ASSERT_TRUE(format.saveFile(file.c_str(), EXS_LittleEndianExplicit).good());
  OddArchive odd("reads-slowly");
  odd.archive().silence_s = silence_s;
  EXPECT_EQ(send(odd.archive(), {file}).files, 1U);
}

}  // namespace
}  // namespace palpate::io
