// Legal or common habits of scanners, archives and anonymizers that a reader can get wrong silently: the encoding of
// files.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcfilefo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "io/load.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

void write_bare(const TestImage& image, const fs::path& path, E_TransferSyntax syntax, E_FileWriteMode mode,
                E_EncodingType lengths, E_GrpLenEncoding groups) {
  DcmFileFormat file;
  fill(*file.getDataset(), image);
  DcmItem* item = nullptr;
  succeed(file.getDataset()->findOrCreateSequenceItem(DCM_ReferencedImageSequence, item, -2));
  succeed(item->putAndInsertString(DCM_ReferencedSOPInstanceUID, "1.2.3"));
  succeed(file.saveFile(OFFilename(path.c_str()), syntax, lengths, groups, EPD_noChange, 0, 0, mode));
}

TEST(OddFiles, WithoutPreambleOrWithGroupLengthsAndOpenSequences) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    for (const E_FileWriteMode mode : {EWM_fileformat, EWM_dataset}) {
      for (const E_EncodingType lengths : {EET_ExplicitLength, EET_UndefinedLength}) {
        for (const E_GrpLenEncoding groups : {EGL_withoutGL, EGL_withGL}) {
          const TestFolder folder;
          for (int k = 0; k < 2; ++k) {
            TestImage image;
            image.z = 2.0 * k;
            write_bare(image, folder / std::to_string(k), syntax, mode, lengths, groups);
          }
          const Catalogue found = find_in(folder);
          ASSERT_THAT(found.series, SizeIs(1)) << syntax << " " << mode << " " << lengths << " " << groups;
          EXPECT_EQ(load(found.series[0]).value_at(3, 2, 1), 32);
        }
      }
    }
  }
}

// An archive that rewrites datasets and leaves what the meta information says of them.
TEST(OddFiles, DatasetWrittenOtherwiseThanItSaysIsRead) {
  const std::string explicit_uid = "1.2.840.10008.1.2.1";
  for (int k = 0; k < 2; ++k) {
    const TestFolder folder;
    for (const int slice : {0, 1}) {
      TestImage image;
      image.z = 2.0 * slice;
      image.syntax = EXS_LittleEndianExplicit;
      write(image, folder / "says");
      image.syntax = EXS_LittleEndianImplicit;
      write(image, folder / "is");
      std::array parts{bytes_of(folder / "says"), bytes_of(folder / "is")};
      fs::remove(folder / "says");
      fs::remove(folder / "is");
      if (k == 1) std::swap(parts[0], parts[1]);
      const auto meta_end = [](const std::string& bytes) { return bytes.find(std::string("\x08\0\x08\0", 4)); };
      write_bytes(folder / numbered("s", slice),
                  parts[0].substr(0, meta_end(parts[0])) + parts[1].substr(meta_end(parts[1])));
    }
    EXPECT_EQ(load(find_in(folder).series.at(0)).value_at(3, 2, 1), 32);
  }
}

TEST(OddFiles, ValuesOfOddLengthAreRead) {
  const TestFolder folder;
  write_stack(folder.path(), 2);
  for (const int k : {0, 1}) {
    const fs::path path = folder / (numbered("s", k) + ".dcm");
    std::string bytes = bytes_of(path);
    const std::string padded("\x08\0\x60\0CS\x02\0CT", 10);
    const std::size_t at = bytes.find(padded);
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, padded.size(), std::string("\x08\0\x60\0CS\x03\0CT ", 11));
    write_bytes(path, bytes);
  }
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.modality, "CT");
  EXPECT_EQ(load(series).value_at(3, 2, 1), 132);
}

// The standard orders elements by their tags. A few that lie behind a higher one are found all the same.
TEST(OddFiles, ElementsOutOfTheirOrderAreRead) {
  const TestFolder folder;
  write_stack(folder.path(), 2);
  for (const int k : {0, 1}) {
    const fs::path path = folder / (numbered("s", k) + ".dcm");
    std::string bytes = bytes_of(path);
    const std::string modality("\x08\0\x60\0CS\x02\0CT", 10);
    const std::size_t at = bytes.find(modality);
    ASSERT_NE(at, std::string::npos);
    bytes.erase(at, modality.size());
    const std::size_t rows = bytes.find(std::string("\x28\0\x10\0US", 6));
    ASSERT_NE(rows, std::string::npos);
    bytes.insert(rows, modality);
    write_bytes(path, bytes);
  }
  const Series series = only_series_in(folder);
  EXPECT_EQ(series.modality, "CT");
  EXPECT_EQ(load(series).value_at(3, 2, 1), 132);
}

// PS3.5 A.4: a sequence delimiter ends the fragments. Some writers leave it out.
TEST(OddFiles, CompressedPixelsWithoutTheirEndMarkAreRead) {
  register_encoders();
  for (const E_TransferSyntax syntax : {EXS_RLELossless, EXS_JPEGProcess14SV1}) {
    for (const std::uintmax_t cut : {0U, 4U, 8U}) {
      const TestFolder folder;
      write_stack(folder.path(), 3, [&](int, TestImage& image) { image.syntax = syntax; });
      for (const auto& entry : fs::directory_iterator(folder.path())) {
        fs::resize_file(entry.path(), fs::file_size(entry.path()) - cut);
      }
      const Catalogue found = find_in(folder);
      ASSERT_THAT(found.series, SizeIs(1));
      EXPECT_THAT(found.skipped, SizeIs(0));
      EXPECT_TRUE(found.series[0].usable);
      const char* const said = "its compressed pixels have no end mark; they are read as they are";
      EXPECT_THAT(found.series[0].warnings, Contains(said).Times(cut == 0 ? 0 : 1));
      EXPECT_EQ(load(found.series[0]).value_at(3, 2, 1), 132);
    }
    const TestFolder folder;
    write_stack(folder.path(), 3, [&](int, TestImage& image) { image.syntax = syntax; });
    fs::resize_file(folder / "s1.dcm", fs::file_size(folder / "s1.dcm") - 12);  // four bytes of the pixels, too
    EXPECT_THAT(find_in(folder).skipped.at(0).reason, HasSubstr("truncated"));
  }
}

}  // namespace
}  // namespace palpate::io::internal
