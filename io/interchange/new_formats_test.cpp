// Rare forms of NIfTI, NRRD and MetaImage: each voxel at the position that the standard defines, with its value.
#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/load.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Rows lps_rows{{{1, 0, 0, -4}, {0, 2, 0, 5}, {0, 0, 3, 6}}};

Vec3 lps(int a, int b, int c) {
  return place_of(lps_rows, a, b, c);
}

const std::string directions = "(1,0,0) (0,2,0) (0,0,3)";

/// A NRRD of int16, with all that says how its axes lie.
std::string nrrd_with(const std::string& axes, const std::string& encoding = "raw", const std::string& type = "short",
                      const std::string& endian = "little") {
  return "NRRD0005\ntype: " + type + "\nspace: LPS\nspace origin: (-4,5,6)\nendian: " + endian +
         "\nencoding: " + encoding + "\n" + axes + "\n";
}

const std::string three_axes = "dimension: 3\nsizes: 4 3 5\nspace directions: " + directions + "\n";

// --- NIfTI-2 ---------------------------------------------------------------------------------------------------------

/// nifti2.h: 540 bytes, of int16 voxels.
class Nifti2 {
 public:
  explicit Nifti2(bool big) : big_(big) {
    put<std::int32_t>(0, 540);
    bytes_.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
    put<std::int16_t>(12, 4).put<std::int16_t>(14, 16);
    const std::array<std::int64_t, 8> size{3, nx, ny, nz, 1, 1, 1, 1};
    for (std::size_t n = 0; n < 8; ++n) put(16 + 8 * n, size[n]).put<double>(104 + 8 * n, 1);
    put<std::int64_t>(168, 544).put<std::int32_t>(500, 2);
  }
  template <typename T>
  Nifti2& put(std::size_t at, T value) {
    std::ranges::copy(as_bytes(value, big_), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
    return *this;
  }
  Nifti2& sform(const Rows& rows) {
    put<std::int32_t>(348, 1);
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t n = 0; n < 4; ++n) put(400 + 32 * row + 8 * n, rows[row][n]);
    }
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool big_;
  std::string bytes_ = std::string(544, '\0');
};

TEST(NewFormats, Nifti2LiesWhereItsFormsSay) {
  for (const bool big : {false, true}) {
    for (const bool gzipped : {false, true}) {
      for (const Rows& rows : {oblique(), flipped()}) {
        const TestFolder folder;
        const std::string bytes = Nifti2(big).sform(rows).bytes() + voxels<std::int16_t>(big);
        const auto file = folder / (gzipped ? "a.nii.gz" : "a.nii");
        write_bytes(file, gzipped ? packed(bytes, 31) : bytes);
        expect_all(
            only_volume(file), [&](int a, int b, int c) { return ras_to_lps * place_of(rows, a, b, c); }, stored);
      }
    }
    // The same quarter turn about z as of NIfTI-1; a slope, an offset and three volumes.
    Nifti2 header(big);
    header.put<std::int32_t>(344, 1).put<double>(112, 2).put<double>(120, 3).put<double>(128, 4);
    header.put<double>(368, std::sqrt(0.5)).put<double>(376, 10).put<double>(384, 20).put<double>(392, 30);
    header.put<double>(176, 0.5).put<double>(184, 7).put<std::int64_t>(16, 4).put<std::int64_t>(48, 3);
    const Rows rows{{{0, -3, 0, 10}, {2, 0, 0, 20}, {0, 0, 4, 30}}};
    const TestFolder folder;
    write_bytes(folder / "a.nii", header.bytes() + voxels<std::int16_t>(big, 3));
    for (int frame = 0; frame < 3; ++frame) {
      expect_all(
          only_volume(folder / "a.nii", frame),
          [&](int a, int b, int c) { return ras_to_lps * place_of(rows, a, b, c); },
          [&](int a, int b, int c) { return 0.5 * (stored(a, b, c) + 1000 * frame) + 7; });
    }
  }
}

// --- Several volumes -------------------------------------------------------------------------------------------------

/// The numbers of three volumes, side by side at each voxel.
std::string side_by_side() {
  std::string bytes;
  for (int n = 0; n < nx * ny * nz; ++n) {
    for (int v = 0; v < 3; ++v) {
      bytes += as_bytes(static_cast<std::int16_t>(stored(n % nx, n / nx % ny, n / (nx * ny)) + 1000 * v));
    }
  }
  return bytes;
}

TEST(NewFormats, VolumesOfAFourthAxisAreFrames) {
  const TestFolder folder;
  const std::string behind = voxels<std::int16_t>(false, 3);
  write_bytes(folder / "last.nrrd", nrrd_with("dimension: 4\nsizes: 4 3 5 3\nkinds: domain domain domain list\nspace "
                                              "directions: " +
                                              directions + " none\n") +
                                        behind);
  write_bytes(folder / "packed.nrrd",
              nrrd_with("dimension: 4\nsizes: 4 3 5 3\nspace directions: " + directions + " none\n", "gzip") +
                  packed(behind, 31));
  write_bytes(folder / "first.nrrd", nrrd_with("dimension: 4\nsizes: 3 4 3 5\nkinds: list domain domain domain\nspace "
                                               "directions: none " +
                                               directions + "\n") +
                                         side_by_side());
  // ITK writes images of four axes so: vectors of four numbers, in a space with time.
  for (const char* const space : {"left-posterior-superior-time", "LPST"}) {
    std::string fields = nrrd_with(
        "dimension: 4\nsizes: 4 3 5 3\nkinds: domain domain domain domain\nspace directions: (1,0,0,0) (0,2,0,0) "
        "(0,0,3,0) (0,0,0,0.7)\n");
    fields.replace(fields.find("LPS"), 3, space);
    fields.replace(fields.find("(-4,5,6)"), 8, "(-4,5,6,0)");
    write_bytes(folder / (std::string(space) + ".nrrd"), fields + behind);
  }
  const std::string four =
      "NDims = 4\nBinaryDataByteOrderMSB = False\nDimSize = 4 3 5 3\nElementType = MET_SHORT\n"
      "ElementSpacing = 1 2 3 0.7\nOffset = -4 5 6 0\n"
      "TransformMatrix = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  write_bytes(folder / "a.mha", four + "ElementDataFile = LOCAL\n" + behind);
  write_bytes(folder / "z.mha", four + "CompressedData = True\nElementDataFile = LOCAL\n" + packed(behind, 15));
  for (const char* const name :
       {"last.nrrd", "packed.nrrd", "first.nrrd", "left-posterior-superior-time.nrrd", "LPST.nrrd", "a.mha", "z.mha"}) {
    SCOPED_TRACE(name);
    const Catalogue found = find_series(std::array{folder / name});
    ASSERT_THAT(found.series, SizeIs(1)) << (found.skipped.empty() ? Text() : found.skipped[0].reason);
    EXPECT_EQ(found.series[0].frames_per_position, 3);
    for (int frame = 0; frame < 3; ++frame) {
      expect_all(only_volume(folder / name, frame), lps,
                 [&](int a, int b, int c) { return stored(a, b, c) + 1000 * frame; });
      const Volume slice = load(found.series[0], {.frame = frame, .slices = LoadOptions::Range{2, 1}});
      EXPECT_EQ(slice.value_at(1, 2, 0), stored(1, 2, 2) + 1000 * frame);
    }
  }
}

TEST(NewFormats, AxesThatAreNeitherSpaceNorFramesAreRefused) {
  for (const char* const kind : {"vector", "3-vector", "complex", "covariant-vector"}) {
    EXPECT_EQ(refusal_of("a.nrrd", nrrd_with("dimension: 4\nsizes: 3 4 3 5\nkinds: " + std::string(kind) +
                                             " domain domain domain\nspace directions: none " + directions + "\n") +
                                       side_by_side()),
              "it holds 3 values for each voxel: save one of them in a file of its own");
  }
  EXPECT_EQ(refusal_of("a.nrrd", nrrd_with("dimension: 4\nsizes: 4 3 3 5\nkinds: domain list domain domain\nspace "
                                           "directions: (1,0,0) none (0,2,0) (0,0,3)\n") +
                                     side_by_side()),
            "it holds 3 values for each voxel: save one of them in a file of its own");
}

// --- Colors ----------------------------------------------------------------------------------------------------------

/// Red, green, blue (and alpha) at each voxel; gray where all are alike.
std::string colored(int parts, bool gray) {
  std::string bytes;
  for (int n = 0; n < nx * ny * nz; ++n) {
    for (int part = 0; part < parts; ++part) {
      bytes += static_cast<char>(part == 3 ? 255 : gray ? 4 * n : (n * (part + 3)) % 256);
    }
  }
  return bytes;
}

// ITU-R BT.601: 0.299 R + 0.587 G + 0.114 B.
TEST(NewFormats, ColorsAreReadAsTheirBrightnessWithAWord) {
  for (const int parts : {3, 4}) {
    for (const bool gray : {false, true}) {
      const TestFolder folder;
      const std::string data = colored(parts, gray);
      const Rows ras{{{-1, 0, 0, 4}, {0, -2, 0, -5}, {0, 0, 3, 6}}};
      write_bytes(folder / "a.nii", Nifti().sform(ras).put<std::int16_t>(70, parts == 3 ? 128 : 2304).bytes() + data);
      write_bytes(folder / "a.nrrd", nrrd_with("dimension: 4\nsizes: " + std::to_string(parts) + " 4 3 5\nkinds: RGB" +
                                                   (parts == 4 ? "A" : "") + "-color domain domain domain\nspace " +
                                                   "directions: none " + directions + "\n",
                                               "raw", "uchar") +
                                         data);
      write_bytes(folder / "a.mha",
                  "NDims = 3\nDimSize = 4 3 5\nElementType = MET_UCHAR\nElementSpacing = 1 2 3\n"
                  "Offset = -4 5 6\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
                  "ElementNumberOfChannels = " +
                      std::to_string(parts) + "\nElementDataFile = LOCAL\n" + data);
      for (const char* const name : {"a.nii", "a.nrrd", "a.mha"}) {
        SCOPED_TRACE(name);
        expect_all(only_volume(folder / name), lps, [&](int a, int b, int c) {
          const int n = (c * ny + b) * nx + a;
          if (gray) return 4.0 * n;
          return std::round(0.299 * (n * 3 % 256) + 0.587 * (n * 4 % 256) + 0.114 * (n * 5 % 256));
        });
        const Series series = find_series(std::array{folder / name}).series.at(0);
        EXPECT_THAT(series.warnings, Contains("its voxels have colors: their brightness is felt, not their colors"));
        EXPECT_THAT(find_structures(std::array{folder / name}).structures, IsEmpty());
      }
    }
  }
}

// --- Encodings -------------------------------------------------------------------------------------------------------

std::string bzipped(const std::string& bytes) {
  std::string out(2 * bytes.size() + 10000, '\0');
  std::size_t used = 0;
  archive* const writer = archive_write_new();
  archive_write_add_filter_bzip2(writer);
  archive_write_set_format_raw(writer);
  archive_write_set_bytes_in_last_block(writer, 1);
  archive_write_open_memory(writer, out.data(), out.size(), &used);
  archive_entry* const entry = archive_entry_new();
  archive_entry_set_pathname(entry, "a");
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_write_header(writer, entry);
  archive_write_data(writer, bytes.data(), bytes.size());
  archive_entry_free(entry);
  archive_write_free(writer);
  out.resize(used);
  return out;
}

std::string in_words(const std::string& between) {
  std::string text;
  for (int n = 0; n < nx * ny * nz; ++n) {
    text += (n == 0 ? "" : between) + std::to_string(stored(n % nx, n / nx % ny, n / (nx * ny)));
  }
  return text;
}

std::string in_hex(const std::string& bytes, const std::string& between) {
  std::string text;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const auto byte = static_cast<unsigned char>(bytes[n]);
    text +=
        std::string(1, "0123456789abcdef"[byte / 16]) + "0123456789ABCDEF"[byte % 16] + (n % 20 == 19 ? between : "");
  }
  return text;
}

TEST(NewFormats, EveryEncodingOfNrrdGivesTheSameVoxels) {
  const std::string data = voxels<std::int16_t>(), big = voxels<std::int16_t>(true);
  struct Case {
    std::string encoding, voxels, endian = "little";
  };
  const std::vector<Case> cases{{"bzip2", bzipped(data)},   {"bz2", bzipped(big), "big"},
                                {"ascii", in_words(" ")},   {"text", in_words("\n")},
                                {"txt", in_words(", ")},    {"ASCII", in_words("\t\r\n") + "\n", "big"},
                                {"hex", in_hex(data, "")},  {"hex", in_hex(big, "\n"), "big"},
                                {"GZIP", packed(data, 31)}, {"gz", packed(big, 31), "big"}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.encoding);
    const TestFolder folder;
    write_bytes(folder / "a.nrrd", nrrd_with(three_axes, one.encoding, "short", one.endian) + one.voxels);
    write_bytes(folder / "b.nhdr", nrrd_with(three_axes + "data file: b.dat\n", one.encoding, "short", one.endian));
    write_bytes(folder / "b.dat", one.voxels);
    for (const char* const name : {"a.nrrd", "b.nhdr"}) {
      expect_all(only_volume(folder / name), lps, stored);
      const Series series = find_series(std::array{folder / name}).series.at(0);
      EXPECT_EQ(load(series, {.slices = LoadOptions::Range{3, 2}}).value_at(2, 1, 1), stored(2, 1, 4));
    }
  }
}

TEST(NewFormats, NumbersInWordsMayBeOfAnyType) {
  const TestFolder folder;
  write_bytes(folder / "a.nrrd",
              nrrd_with("dimension: 3\nsizes: 2 2 2\nspace directions: " + directions + "\n", "ascii", "double") +
                  "1.5 -2e3 0.25 1e-3\n4 5 6 -7.75");
  const Volume volume = only_volume(folder / "a.nrrd");
  EXPECT_EQ(volume.value_at(1, 0, 0), -2000);
  EXPECT_EQ(volume.value_at(1, 1, 1), -7.75);
}

TEST(NewFormats, EncodingsThatAreDamagedAreRefusedInWords) {
  const auto refused = [](const std::string& encoding, const std::string& bytes) {
    return verdict_on_voxels(nrrd_with(three_axes, encoding) + bytes);
  };
  const std::string bzip2 = bzipped(voxels<std::int16_t>());
  for (std::size_t n = 0; n + 1 < bzip2.size(); n += 7) {
    std::string bad = bzip2;
    bad[n] = static_cast<char>(bad[n] ^ 0x10);
    EXPECT_THAT(refused("bzip2", bad), ::testing::AnyOf(::testing::HasSubstr("its checksum is wrong"),
                                                        ::testing::HasSubstr("ends before its last voxel")))
        << n;
  }
  EXPECT_THAT(refused("ascii", in_words(" ").substr(0, in_words(" ").rfind(' ', 150))),
              ::testing::HasSubstr("ends before its last voxel"));
  EXPECT_THAT(
      refused("ascii", "12 none " + in_words(" ")),
      ::testing::HasSubstr("its voxels are written as text, and \"none\" is no number of its type: export it again"));
  EXPECT_THAT(refused("ascii", "40000 " + in_words(" ")), ::testing::HasSubstr("\"40000\" is no number of its type"));
  EXPECT_THAT(refused("ascii", std::string(400, '7')), ::testing::HasSubstr("is no number of its type"));
  EXPECT_THAT(refused("hex", in_hex(voxels<std::int16_t>(), "").substr(1)),
              ::testing::HasSubstr("ends before its last voxel"));
  EXPECT_THAT(refused("hex", in_hex(voxels<std::int16_t>(), "").replace(40, 1, "g")),
              ::testing::HasSubstr("\"g\" is no number of its type"));
  EXPECT_THAT(refused("lzma", bzip2), "its encoding \"lzma\" is not read; there are: raw, gzip, bzip2, ascii, hex");
}

// What is wrong behind the last voxel is seen, too, in files larger than what is unpacked at once.
TEST(NewFormats, AWrongChecksumAtTheEndOfBzip2IsNoticed) {
  for (const int slices : {1, 64}) {
    const std::string header = nrrd_with(
        "dimension: 3\nsizes: 64 64 " + std::to_string(slices) + "\nspace directions: " + directions + "\n", "bzip2");
    std::string bytes;
    for (int n = 0; n < 64 * 64 * slices; ++n)
      bytes += as_bytes(static_cast<std::int16_t>((n * 7919 + n / 4096 * 31) % 4001));
    const std::string whole = bzipped(bytes);
    for (std::size_t n = 0; n <= 5; ++n) {
      std::string bad = whole;
      // The last byte may hold nothing but filling; those before it are the checksum's.
      if (n > 0) bad[bad.size() - n] = static_cast<char>(bad[bad.size() - n] ^ 0x80);
      const TestFolder folder;
      write_bytes(folder / "a.nrrd", header + bad);
      const Catalogue found = find_series(std::array{folder / "a.nrrd"});
      if (found.series.empty()) {  // a small one is unpacked whole where it is found
        EXPECT_GT(n, 0U);
        EXPECT_THAT(std::string(found.skipped.at(0).reason), ::testing::HasSubstr("its checksum is wrong"));
      } else if (n == 0) {
        EXPECT_NO_THROW(load(found.series[0]));
      } else {
        EXPECT_THROW(load(found.series[0]), DicomError) << slices << " slices, byte " << n << " from the end";
      }
    }
  }
}

TEST(NewFormats, ANiftiThatIsPackedByBzip2IsUnpacked) {
  const TestFolder folder;
  write_bytes(folder / "a.nii.bz2", bzipped(Nifti().sform(oblique()).bytes() + voxels<std::int16_t>()));
  expect_all(
      only_volume(folder / "a.nii.bz2"), [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); },
      stored);
}

// --- 64 bits ---------------------------------------------------------------------------------------------------------

TEST(NewFormats, IntegersOf64BitsAreExactUpTo24BitsAndBeyondSaidToBeRounded) {
  for (const std::int64_t largest :
       {std::int64_t{1} << 15, (std::int64_t{1} << 24) - 1, (std::int64_t{1} << 24) + 1, (std::int64_t{1} << 53) + 1}) {
    for (const bool is_signed : {false, true}) {
      std::string data;
      for (int n = 0; n < nx * ny * nz; ++n) {
        const std::int64_t value = n == 7 ? largest : n == 8 && is_signed ? -largest : n;
        data += as_bytes(value);
      }
      const TestFolder folder;
      write_bytes(folder / "a.nrrd", nrrd_with(three_axes, "raw", is_signed ? "int64" : "uint64") + data);
      const Volume volume = only_volume(folder / "a.nrrd");
      const bool fits = largest < std::int64_t{1} << 24;
      EXPECT_EQ(volume.value_at(3, 1, 0), static_cast<double>(static_cast<float>(largest)));
      EXPECT_EQ(volume.value_at(3, 2, 0), 11);
      EXPECT_EQ(volume.warnings.empty(), fits) << largest;
      if (!fits) {
        EXPECT_THAT(volume.warnings,
                    Contains("its values have more digits than are kept: they are rounded to 24 bits"));
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal
