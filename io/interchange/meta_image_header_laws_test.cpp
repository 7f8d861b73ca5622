// What the header of MetaImage may say, field by field, and what of it is refused.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

const std::string meta_refusal = "it is no MetaImage of three or four dimensions in binary: save it as such";

/// itk::MetaImageIO: T, t or 1 begins what is true.
TEST(MetaImageHeader, TruthIsWrittenInSeveralWays) {
  for (const auto& [word, is] : {std::pair{"True", true},
                                 {"true", true},
                                 {"T", true},
                                 {"1", true},
                                 {"False", false},
                                 {"false", false},
                                 {"F", false},
                                 {"0", false}}) {
    SCOPED_TRACE(word);
    const std::string order = is ? "ElementByteOrderMSB = " : "BinaryDataByteOrderMSB = ";
    const std::string data = voxels<std::int16_t>(is);
    const std::string header = "NDims = 3\nDimSize = 4 3 5\nElementType = MET_SHORT\n" + order + word +
                               "\nCompressedData = " + word + "\n" + meta_place;
    const TestFolder folder;
    for (const char* const local : {"LOCAL", "Local", "local"}) {
      write_bytes(folder / "a.mha", header + "ElementDataFile = " + local + "\n" + (is ? packed(data, 15) : data));
      expect_all(
          only_volume(folder / "a.mha"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
    }
    EXPECT_EQ(verdict_on("a.mha", "NDims = 3\nDimSize = 4 3 5\nElementType = MET_SHORT\nBinaryData = " +
                                      std::string(word) + "\nElementDataFile = LOCAL\n" + voxels<std::int16_t>()),
              is ? "read" : meta_refusal);
  }
}

TEST(MetaImageHeader, NumbersAreAsManyAsItsAxes) {
  const auto with = [](const std::string& field) {
    std::string header = "NDims = 3\nDimSize = 4 3 5\nElementType = MET_SHORT\n" + meta_place;
    const std::string name = field.substr(0, field.find(' '));
    if (const std::size_t at = header.find(name + " ="); at != std::string::npos) {
      header.erase(at, header.find('\n', at) + 1 - at);
    }
    return verdict_on("a.mha", header + field + "\nElementDataFile = LOCAL\n" + voxels<std::int16_t>(false, 4));
  };
  for (const char* const good :
       {"NDims = 3", "DimSize = 4 3 5", "ElementSpacing = 1 2 3", "ElementSpacing = 1 2 3 4", "Offset = 1 2 3",
        "ElementNumberOfChannels = 1", "TransformMatrix = 1 0 0 0 1 0 0 0 1"}) {
    EXPECT_EQ(with(good), "read") << good;
  }
  for (const char* const bad :
       {"NDims = 2", "NDims = 4", "NDims = ", "DimSize = 4 3", "DimSize = 4 3 5 2", "DimSize = 4 3 5 2 1",
        "ElementSpacing = 1 2", "Offset = 1", "TransformMatrix = 1 0 0 0 1 0 0 0", "TransformMatrix = 1 0 0 1",
        "TransformMatrix = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"}) {
    EXPECT_EQ(with(bad), meta_refusal) << bad;
  }
  for (const char* const none :
       {"DimSize = 0 3 5", "DimSize = 4 -3 5", "DimSize = 4 3 nan", "DimSize = inf 3 5", "ElementSpacing = 0 1 1",
        "ElementSpacing = nan 1 1", "Offset = nan 0 0", "TransformMatrix = 1 0 0 1 0 0 0 0 1"}) {
    EXPECT_EQ(with(none), no_lattice) << none;
  }
  for (const char* const other : {"ElementType = MET_OTHER", "ElementType = short", "ElementType = "}) {
    EXPECT_EQ(with(other), "its voxels are of a type that is not read: save it as numbers of 8 to 64 bits") << other;
  }
  EXPECT_EQ(with("ElementNumberOfChannels = 2"),
            "it holds 2 values for each voxel: save one of them in a file of its own");
}

/// With a fourth axis its matrix has a row more, and its directions are the first three parts of the first three rows.
TEST(MetaImageHeader, AFourthAxisTakesNothingFromTheOthers) {
  const std::string data = voxels<std::int16_t>(false, 2);
  const std::string header =
      "NDims = 4\nDimSize = 4 3 5 2\nElementType = MET_SHORT\nElementSpacing = 0.5 2 3 9\nOffset = -12 5 90 8\n"
      "TransformMatrix = 0.6 0.8 0 0 -0.8 0.6 0 0 0 0 -1 0 0 0 0 1\n";
  for (const std::string skip : {"", "HeaderSize = 0\n", "HeaderSize = -1\n"}) {
    const TestFolder folder;
    write_bytes(folder / "a.mha",
                header + skip + "ElementDataFile = LOCAL\n" + (skip.find('-') == skip.npos ? "" : "xyz") + data);
    for (const int frame : {0, 1}) {
      expect_all(
          only_volume(folder / "a.mha", frame), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); },
          [&](int a, int b, int c) { return stored(a, b, c) + 1000 * frame; });
    }
  }
}

/// A fourth axis has from one to a million volumes.
TEST(MetaImageHeader, AFourthAxisOfNoCountIsRefused) {
  for (const char* const count : {"0", "-2", "nan", "inf", "0.5", "1000001", "1e300"}) {
    EXPECT_EQ(verdict_on("a.mha", "NDims = 4\nDimSize = 4 3 5 " + std::string(count) +
                                      "\nElementType = MET_SHORT\nElementSpacing = 1 1 1 1\nOffset = 0 0 0 0\n"
                                      "ElementDataFile = LOCAL\n" +
                                      voxels<std::int16_t>(false, 2)),
              no_lattice)
        << count;
  }
}

/// HeaderSize: from the first byte on, however few.
TEST(MetaImageHeader, AnyCountOfBytesIsSkipped) {
  for (const int count : {0, 1, 2, 3, 1000}) {
    const TestFolder folder;
    write_bytes(folder / "a.raw",
                std::string(static_cast<std::size_t>(count), 'x') + voxels<std::int16_t>() + "and more");
    write_bytes(folder / "a.mhd",
                meta_image(meta_place + "HeaderSize = " + std::to_string(count) + "\nElementDataFile = a.raw\n"));
    SCOPED_TRACE(count);
    expect_all(
        only_volume(folder / "a.mhd"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
  }
}

/// Its header ends with ElementDataFile, whatever the voxels look like. Lines may end as on Windows, be indented, or
/// say nothing.
TEST(MetaImageHeader, EndsWithTheNameOfItsData) {
  std::string data = voxels<std::int16_t>();
  data.replace(0, 14, "\nDimSize = 1 1");
  const std::string header = meta_image(meta_place + "Comment\n\n  Modality =MET_MOD_CT  \n");
  std::string windows = header;
  for (std::size_t at = windows.find('\n'); at != std::string::npos; at = windows.find('\n', at + 2)) {
    windows.insert(at, "\r");
  }
  for (const std::string& lines : {header, windows}) {
    const TestFolder folder;
    write_bytes(folder / "a.mha", lines + "ElementDataFile = LOCAL\n" + data);
    const Volume volume = only_volume(folder / "a.mha");
    ASSERT_EQ(volume.geometry.dimensions, glm::ivec3(nx, ny, nz));
    const Vec3 at = volume.geometry.to_index(place_of(meta_rows, 3, 2, 4));
    EXPECT_EQ(volume.value_at(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)),
                              static_cast<int>(std::lround(at.z))),
              stored(3, 2, 4));
  }
  EXPECT_NE(verdict_on("a.mha", header), "read") << "nothing says where its data are";
  EXPECT_NE(verdict_on("a.txt", header + "ElementDataFile = LOCAL\n" + data), "read");
  for (const char* const name : {"A.MHA", "a.mhd"}) {
    EXPECT_EQ(verdict_on(name, header + "ElementDataFile = LOCAL\n" + data), "read");
  }
}

/// As older versions of ITK name colors.
TEST(MetaImageHeader, AnArrayIsOfTheTypeThatItNames) {
  const std::string header =
      "NDims = 3\nDimSize = 4 3 5\nElementType = MET_UCHAR_ARRAY\nElementNumberOfChannels = 3\n" + meta_place +
      "ElementDataFile = LOCAL\n";
  const TestFolder folder;
  std::string data;
  for (int n = 0; n < nx * ny * nz; ++n) data += std::string(3, static_cast<char>(4 * n));
  write_bytes(folder / "a.mha", header + data);
  expect_all(
      only_volume(folder / "a.mha"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); },
      [](int a, int b, int c) { return 4 * ((c * ny + b) * nx + a); });
}

}  // namespace
}  // namespace palpate::io::internal
