// Headers of other formats that a reader can get wrong silently: positions a thousandfold off, the rest of a header
// read as values, damage that only a checksum reveals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "io/errors.h"
#include "io/load.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/comma_locale.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

using ::testing::Contains;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::string nrrd_place = "space: LPS\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (-4,5,6)\n";

std::string nrrd_of(const std::string& fields) {
  return "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 5\nendian: little\nencoding: raw\n" + fields + "\n";
}

Vec3 nrrd_at(int a, int b, int c) {
  return {a - 4, 2 * b + 5, 3 * c + 6};
}

// Lines end where the header ends, and nowhere before.
TEST(SilentFormats, ANrrdHeaderOfAnyLengthIsReadToItsEnd) {
  for (const int lines : {0, 99'990, 100'001, 300'000}) {
    std::string comments;
    for (int n = 0; n < lines; ++n) comments += "#\n";
    const TestFolder folder;
    write_bytes(folder / "a.nrrd", nrrd_of(comments + nrrd_place) + voxels<std::int16_t>());
    expect_all(only_volume(folder / "a.nrrd"), nrrd_at, stored);
  }
}

TEST(SilentFormats, AHeaderWithoutAnEndIsRefused) {
  const std::string endless = std::string((1U << 26) + 10, '#');
  const std::string why = "its header has no end, or more than 64 MiB: copy or export it again";
  EXPECT_EQ(refusal_of("a.nrrd", "NRRD0004\n" + endless), why);
  EXPECT_EQ(refusal_of("a.mha", "NDims = 3\n" + endless), why);
}

// The unit is that of an axis of the space, for directions and for the origin.
TEST(SilentFormats, ANrrdsPlacesAreInItsSpaceUnits) {
  struct Unit {
    const char* name;
    double mm;
  };
  for (const Unit& unit : {Unit{"mm", 1}, Unit{"um", 1e-3}, Unit{"\u00b5m", 1e-3}, Unit{"\u03bcm", 1e-3},
                           Unit{"microns", 1e-3}, Unit{"cm", 10}, Unit{"m", 1000}, Unit{"MM", 1}, Unit{"", 1}}) {
    SCOPED_TRACE(unit.name);
    const auto in_unit = [&](double mm) { return std::to_string(mm / unit.mm); };
    const std::string name = "\"" + std::string(unit.name) + "\"";
    const TestFolder folder;
    write_bytes(folder / "a.nrrd", nrrd_of("space: LPS\nspace units: " + name + " \"mm\" " + name +
                                           "\nspace directions: (" + in_unit(1) + ",0,0) (0,2,0) (0,0," + in_unit(3) +
                                           ")\nspace origin: (" + in_unit(-4) + ",5," + in_unit(6) + ")\n") +
                                       voxels<std::int16_t>());
    expect_all(only_volume(folder / "a.nrrd"), nrrd_at, stored);
  }
  EXPECT_EQ(
      refusal_of("a.nrrd", nrrd_of(nrrd_place + "space units: \"mm\" \"mm\" \"furlongs\"\n") + voxels<std::int16_t>()),
      "its places are in \"furlongs\", which is no unit of length that is known here: save it in mm");
}

// nifti_quatern_to_mat44() of nifti1_io.c: a quaternion longer than 1 is one of length 1, a half turn.
TEST(SilentFormats, ANiftiQuaternionLongerThanOneIsMadeOne) {
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0.6, 0.8), Vec3(2.0 / 7, 3.0 / 7, 6.0 / 7)}) {
    for (const double length : {1.0, 1.0000001, 1.001, 1.56, 30.0}) {
      const Vec3 quaternion = length * axis;
      Nifti header;
      header.put<std::int16_t>(252, 1).put<float>(76, 1).put<float>(80, 2).put<float>(84, 3).put<float>(88, 4);
      for (int n = 0; n < 3; ++n) header.put(256 + 4 * static_cast<std::size_t>(n), static_cast<float>(quaternion[n]));
      const auto half_turn = [&](const Vec3& v) { return 2 * glm::dot(axis, v) * axis - v; };
      const TestFolder folder;
      write_bytes(folder / "a.nii", header.bytes() + voxels<std::int16_t>());
      expect_all(
          only_volume(folder / "a.nii"),
          [&](int a, int b, int c) { return ras_to_lps * half_turn(Vec3(2 * a, 3 * b, 4 * c)); }, stored);
    }
  }
}

std::string why_not_loaded(const std::filesystem::path& file, int frame = 0) {
  const Catalogue found = find_series(std::array{file});
  if (found.series.empty()) return found.skipped.at(0).reason;
  try {
    load(found.series[0], {.frame = frame});
  } catch (const DicomError& error) {
    return error.what();
  }
  return "loaded";
}

// A bit that is wrong in the stored checksum, or in stored (not packed) values, is seen by nothing else.
TEST(SilentFormats, AWrongChecksumIsNoticedWhateverFrameIsRead) {
  const std::string data = voxels<std::int16_t>(false, 3);
  Nifti three;
  three.sform(oblique()).put<std::int16_t>(40, 4).put<std::int16_t>(48, 3);
  const std::string whole = packed(three.bytes() + data, 31);
  for (int frame = 0; frame < 3; ++frame) {
    const TestFolder folder;
    write_bytes(folder / "good.nii.gz", whole);
    EXPECT_EQ(why_not_loaded(folder / "good.nii.gz", frame), "loaded");
    for (std::size_t n = 1; n <= 8; ++n) {  // its checksum, and how much there was (RFC 1952)
      std::string bad = whole;
      bad[bad.size() - n] = static_cast<char>(bad[bad.size() - n] ^ 4);
      write_bytes(folder / "bad.nii.gz", bad);
      EXPECT_THAT(why_not_loaded(folder / "bad.nii.gz", frame),
                  ::testing::HasSubstr(
                      "its content was damaged after it was written (its checksum is wrong): copy or export it again"));
    }
  }
  for (const char* const name : {"a.nrrd", "a.mha"}) {
    const bool is_nrrd = std::string(name) == "a.nrrd";
    std::string header = nrrd_of(nrrd_place);
    if (is_nrrd) header.replace(header.find("raw"), 3, "gzip");
    if (!is_nrrd) header = meta_image(meta_place + "CompressedData = True\nElementDataFile = LOCAL\n");
    std::string bad = header + packed(voxels<std::int16_t>(), is_nrrd ? 31 : 15);
    bad[bad.size() - (is_nrrd ? 6 : 2)] ^= 1;
    const TestFolder folder;
    write_bytes(folder / name, bad);
    EXPECT_THAT(why_not_loaded(folder / name), ::testing::HasSubstr("its checksum is wrong")) << name;
  }
}

// itk::MetaImage: HeaderSize counts from the beginning of the file with the voxels, also where that is the header's
// own.
TEST(SilentFormats, AMetaImagesHeaderSizeHoldsForVoxelsInTheHeadersFile) {
  for (const std::size_t gap : {0U, 1U, 6U, 1000U}) {
    std::string header = meta_image(meta_place + "HeaderSize = 99999\nElementDataFile = LOCAL\n");
    const std::size_t said = 10000 + gap;
    header.replace(header.find("99999"), 5, std::to_string(said));
    header.resize(said, 'x');
    const TestFolder folder;
    write_bytes(folder / "a.mha", header + voxels<std::int16_t>());
    expect_all(
        only_volume(folder / "a.mha"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
    write_bytes(folder / "a.mha", meta_image(meta_place + "HeaderSize = -1\nElementDataFile = LOCAL\n") +
                                      std::string(gap, 'x') + voxels<std::int16_t>());
    expect_all(
        only_volume(folder / "a.mha"), [](int a, int b, int c) { return place_of(meta_rows, a, b, c); }, stored);
  }
}

TEST(SilentFormats, AMetaImageOfLabelsSaysWhatItsHeaderDoesNotSayToo) {
  const TestFolder folder;
  write_bytes(folder / "a.mha", meta_image("ElementSpacing = 1 1 1\nElementDataFile = LOCAL\n") + labels());
  const StructureCatalogue found = find_structures(std::array{folder / "a.mha"});
  ASSERT_THAT(found.structures, SizeIs(1));
  EXPECT_THAT(
      found.structures[0].warnings,
      Contains(StartsWith("its header does not say Offset, TransformMatrix: 1 mm, no rotation and the origin")));
}

TEST(SilentFormats, AMetaImageSaysWhatItsHeaderDoesNotSay) {
  struct Case {
    std::string fields, missing;
  };
  const std::string spacing = "ElementSpacing = 1 1 1\n", offset = "Offset = 0 0 0\n",
                    turn = "TransformMatrix = 1 0 0 0 1 0 0 0 1\n";
  for (const Case& one : {Case{"", "ElementSpacing, Offset, TransformMatrix"}, Case{spacing, "Offset, TransformMatrix"},
                          Case{spacing + offset, "TransformMatrix"}, Case{offset + turn, "ElementSpacing"},
                          Case{"ElementSize = 1 1 1\nPosition = 0 0 0\nRotation = 1 0 0 0 1 0 0 0 1\n", ""},
                          Case{spacing + offset + turn, ""}}) {
    const TestFolder folder;
    write_bytes(folder / "a.mha", meta_image(one.fields + "ElementDataFile = LOCAL\n") + voxels<std::int16_t>());
    const Series series = find_series(std::array{folder / "a.mha"}).series.at(0);
    if (one.missing.empty()) {
      EXPECT_THAT(series.warnings, Not(Contains(StartsWith("its header does not say"))));
    } else {
      EXPECT_THAT(series.warnings, Contains("its header does not say " + one.missing +
                                            ": 1 mm, no rotation and the origin are taken, as other programs do; "
                                            "places may be wrong"));
    }
  }
}

// A host program may run in a country that writes 0,75: a part of each number would be read, and no word said.
TEST(SilentFormats, ADecimalCommaOfTheLocaleChangesNoNumber) {
  const Rows fine{{{0.75, 0, 0, -4.25}, {0, 1.5, 0, 5.125}, {0, 0, 2.5, -0.0625}}};
  const std::string nrrd =
      "space: LPS\nspace directions: (0.75,0,0) (0,+1.5e0,0) (0,0,25E-1)\nspace origin: (-4.25,5.125,-6.25e-2)\n";
  const std::string meta =
      "ElementSpacing = 0.75 +1.5e0 25E-1\nOffset = -4.25 5.125 -6.25e-2\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n";
  const TestFolder folder;
  write_bytes(folder / "a.nrrd", nrrd_of(nrrd) + voxels<std::int16_t>());
  write_bytes(folder / "a.mha", meta_image(meta + "ElementDataFile = LOCAL\n") + voxels<std::int16_t>());
  std::string words;
  for (int n = 0; n < nx * ny * nz; ++n)
    words += std::to_string(stored(n % nx, n / nx % ny, n / (nx * ny)) + 0.25) + " ";
  std::string in_words = nrrd_of(nrrd);
  in_words.replace(in_words.find("short"), 5, "float").replace(in_words.find("raw"), 3, "ascii");
  write_bytes(folder / "words.nrrd", in_words + words);
  const auto at = [&](int a, int b, int c) { return place_of(fine, a, b, c); };
  const auto expect_whole = [&] {
    expect_all(only_volume(folder / "a.nrrd"), at, stored);
    expect_all(only_volume(folder / "a.mha"), at, stored);
    expect_all(only_volume(folder / "words.nrrd"), at, [](int a, int b, int c) { return stored(a, b, c) + 0.25; });
  };
  expect_whole();
  const CommaLocale comma;
  if (!comma.is_set()) GTEST_SKIP() << CommaLocale::needed;
  expect_whole();
}

}  // namespace
}  // namespace palpate::io::internal
