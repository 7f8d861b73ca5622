// Which files are whole scans, and which belong to a series in their folder.
#include "io/whole_scan.h"

#include <gtest/gtest.h>

#include <string>

#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

TEST(WholeScan, OfOtherFormatsIsKnownByTheName) {
  const TestFolder folder;
  for (const char* const name : {"a.nii", "a.nii.gz", "a.nrrd", "a.nhdr", "a.mha", "a.mhd", "A.NII", "b.c.Nii.Gz"}) {
    write_bytes(folder / name, "");
    EXPECT_TRUE(holds_whole_scans(folder / name)) << name;
  }
  for (const char* const name : {"a", "a.raw", "nii", "a.nii.txt", "mha.dcm"}) {
    write_bytes(folder / name, "");
    EXPECT_FALSE(holds_whole_scans(folder / name)) << name;
  }
}

TEST(WholeScan, PackedStudyIsKnownByItsFirstBytes) {
  const TestFolder folder;
  write_bytes(folder / "study", "PK\3\4 and so on");
  write_bytes(folder / "study.zip", "no archive");
  const std::string gzipped = packed("bytes", 31);
  write_bytes(folder / "study.tgz", gzipped);
  write_bytes(folder / "a.dcm.gz", gzipped);
  EXPECT_TRUE(holds_whole_scans(folder / "study"));
  EXPECT_FALSE(holds_whole_scans(folder / "study.zip"));
  EXPECT_TRUE(holds_whole_scans(folder / "study.tgz"));
  EXPECT_FALSE(holds_whole_scans(folder / "a.dcm.gz")) << "one image of a series";
}

TEST(WholeScan, DicomFileFolderAndWhatIsNotThereAreNone) {
  const TestFolder folder;
  write_stack(folder.path(), 1);
  std::filesystem::create_directory(folder / "folder.nii");
  EXPECT_FALSE(holds_whole_scans(folder / "s0.dcm"));
  EXPECT_FALSE(holds_whole_scans(folder / "folder.nii"));
  EXPECT_FALSE(holds_whole_scans(folder / "absent.nii"));
}

}  // namespace
}  // namespace palpate::io::internal
