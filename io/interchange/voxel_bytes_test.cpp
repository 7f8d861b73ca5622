// Voxels as they lie in a file: packed in parts, as words, to the last byte and not one less.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/geometric.hpp>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "io/errors.h"
#include "io/interchange/voxel_file.h"
#include "io/load.h"
#include "io/reach.h"
#include "io/series.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string nrrd_in(const std::string& type, const std::string& encoding, const std::string& sizes = "4 3 5") {
  return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: " + sizes +
         "\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nendian: little\nencoding: " +
         encoding + "\n\n";
}

/// RFC 1952, 2.2: a file may consist of several members, one behind the other.
TEST(VoxelBytes, MayBePackedInParts) {
  const std::string data = voxels<std::int16_t>(), nifti = Nifti().sform(oblique()).bytes() + data;
  for (const std::size_t part : {1U, 7U, 100U, 352U, 400U, 5000U}) {
    const auto in_parts = [&](const std::string& bytes) {
      std::string all;
      for (std::size_t at = 0; at < bytes.size(); at += part) all += packed(bytes.substr(at, part), 31);
      return all;
    };
    const TestFolder folder;
    write_bytes(folder / "a.nii.gz", in_parts(nifti));
    expect_all(
        only_volume(folder / "a.nii.gz"),
        [&](int a, int b, int c) { return ras_to_lps * place_of(oblique(), a, b, c); }, stored);
    write_bytes(folder / "a.nrrd", nrrd_in("short", "gzip") + in_parts(data));
    expect_all(
        only_volume(folder / "a.nrrd"), [](int a, int b, int c) { return Vec3(a, b, c); }, stored);
    for (const std::size_t less : {1U, 8U, 9U}) {
      const std::string whole = in_parts(data);
      EXPECT_NE(verdict_on_voxels(nrrd_in("short", "gzip") + whole.substr(0, whole.size() - less)), "loaded") << less;
    }
  }
}

/// Larger than what is unpacked at once: every slice of every volume is its own.
TEST(VoxelBytes, OfLargeFilesAreThoseOfTheirPlace) {
  constexpr int wide = 256, slices = 12, volumes = 3;
  Nifti header;
  header.sform({{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}}});
  header.put<std::int16_t>(40, 4).put<std::int16_t>(42, wide).put<std::int16_t>(44, wide);
  header.put<std::int16_t>(46, slices).put<std::int16_t>(48, volumes);
  const auto value = [](int n) { return static_cast<std::int16_t>(n % 30011); };
  std::string data;
  data.reserve(2U * wide * wide * slices * volumes);
  for (int n = 0; n < wide * wide * slices * volumes; ++n) data += as_bytes(value(n));
  const TestFolder folder;
  write_bytes(folder / "a.nii", header.bytes() + data);
  write_bytes(folder / "a.nii.gz", packed(header.bytes() + data, 31));
  for (const char* const name : {"a.nii", "a.nii.gz"}) {
    const Series series = find_series(std::array{folder / name}).series.at(0);
    for (int frame = 0; frame < volumes; ++frame) {
      for (const auto& [first, count] : {std::pair{0, slices}, {slices - 1, 1}, {5, 2}}) {
        const Volume part = load(series, {.frame = frame, .slices = LoadOptions::Range{first, count}});
        for (int k = 0; k < count; ++k) {
          for (const int n : {0, 1, wide, wide * wide / 2 + 3, wide * wide - 1}) {
            ASSERT_EQ(part.value_at(n % wide, n / wide, k), value(((frame * slices + first + k) * wide * wide) + n))
                << name << ' ' << frame << ' ' << first + k << ' ' << n;
          }
        }
      }
    }
  }
}

/// With its last byte a file is whole; with one less it is not.
TEST(VoxelBytes, EndWithTheLastVoxelInEveryEncoding) {
  const std::string early = "it ends before its last voxel: copy or export it again";
  const std::string data(nx * ny * nz, '\1');
  std::string words, hex;
  for (int n = 0; n < nx * ny * nz; ++n) {
    words += n == 0 ? "1" : " 1";
    hex += "01";
  }
  const std::string packed_data = packed(data, 31);
  for (const auto& [encoding, bytes] :
       {std::pair{"raw", data}, {"ascii", words}, {"hex", hex}, {"gzip", packed_data}}) {
    const std::string header = nrrd_in("uint8", encoding);
    EXPECT_EQ(verdict_on_voxels(header + bytes), "loaded") << encoding;
    EXPECT_THAT(verdict_on_voxels(header + bytes.substr(0, bytes.size() - 1)), HasSubstr(early)) << encoding;
    EXPECT_EQ(verdict_on_voxels(header + bytes + "\n"), "loaded") << encoding << ", and a line's end";
  }
}

/// Each type takes its own numbers as words, whole words, and no others.
TEST(VoxelBytes, WordsAreNumbersOfTheirType) {
  struct Type {
    const char* name;
    std::vector<std::string> good, bad;
  };
  const std::vector<Type> types{
      {"uint8", {"0", "255", "007"}, {"256", "-1", "1.0", "1e2", "0x1", "1a", "one", "--1"}},
      {"int8", {"-128", "127"}, {"-129", "128", "1."}},
      {"uint16", {"65535"}, {"65536", "-1"}},
      {"int16", {"-32768", "32767"}, {"-32769", "32768"}},
      {"uint32", {"4294967295"}, {"4294967296", "-1"}},
      {"int32", {"-2147483648", "2147483647"}, {"-2147483649", "2147483648"}},
      {"uint64", {"18446744073709551615"}, {"18446744073709551616", "-1"}},
      {"int64", {"-9223372036854775808", "9223372036854775807"}, {"-9223372036854775809", "9223372036854775808"}},
      {"float", {"1", "-1.5", "1e30", "2.5E-3", "0." + std::string(62, '1')}, {"1e60", "1.5.2", "x", "1f"}},
      {"double", {"1e300", "-2.25"}, {"1e400", "1d5"}}};
  for (const Type& type : types) {
    const auto verdict_with = [&](const std::string& word) {
      std::string words = word;
      for (int n = 1; n < nx * ny * nz; ++n) words += " 1";
      return verdict_on_voxels(nrrd_in(type.name, "ascii") + words);
    };
    for (const std::string& word : type.good) EXPECT_EQ(verdict_with(word), "loaded") << type.name << ' ' << word;
    for (const std::string& word : type.bad) {
      EXPECT_THAT(verdict_with(word), HasSubstr("\"" + word + "\" is no number of its type")) << type.name;
    }
    EXPECT_THAT(verdict_with(std::string(65, '0') + "1"), HasSubstr("is no number of its type")) << "no end of it";
  }
}

/// Only integers are rounded to 24 bits: numbers with a point are what a float is for.
TEST(VoxelBytes, NumbersWithAPointAreNotSaidToBeRounded) {
  for (const bool is_double : {false, true}) {
    std::string data;
    for (int n = 0; n < nx * ny * nz; ++n)
      data += is_double ? as_bytes(0.1 * n + 1e9) : as_bytes(0.1F * static_cast<float>(n) + 1e17F);
    const TestFolder folder;
    write_bytes(folder / "a.nrrd", nrrd_in(is_double ? "double" : "float", "raw") + data);
    const Volume volume = only_volume(folder / "a.nrrd");
    EXPECT_THAT(volume.warnings, IsEmpty());
    EXPECT_FALSE(volume.padding) << "all are numbers";
  }
}

/// Beyond 2^53 a double has not all digits either, on both sides of 0.
TEST(VoxelBytes, LargeIntegersOfEitherSignAreSaidToBeRounded) {
  for (const std::int64_t value : {(std::int64_t{1} << 53) - (1 << 29), std::int64_t{1} << 53, std::int64_t{1} << 60}) {
    for (const int sign : {-1, 1}) {
      std::string data;
      for (int n = 0; n < nx * ny * nz; ++n) data += as_bytes(n == 7 ? sign * value : std::int64_t{n});
      const TestFolder folder;
      write_bytes(folder / "a.nrrd", nrrd_in("int64", "raw") + data);
      EXPECT_EQ(only_volume(folder / "a.nrrd").warnings.empty(), value < std::int64_t{1} << 53) << sign * value;
    }
  }
}

/// Numbers of up to 16 bits are kept as they are stored, and others as floats.
TEST(VoxelBytes, AreKeptAsSmallAsTheyAre) {
  for (const auto& [type, bytes, index] : {std::tuple{"uint8", 1, 1},
                                           {"uint16", 2, 1},
                                           {"int8", 1, 0},
                                           {"int16", 2, 0},
                                           {"uint32", 4, 2},
                                           {"int32", 4, 2},
                                           {"float", 4, 2},
                                           {"double", 8, 2},
                                           {"int64", 8, 2},
                                           {"uint64", 8, 2}}) {
    const TestFolder folder;
    write_bytes(folder / "a.nrrd",
                nrrd_in(type, "raw") + std::string(static_cast<std::size_t>(nx * ny * nz * bytes), '\0'));
    const Volume volume = only_volume(folder / "a.nrrd");
    EXPECT_EQ(std::holds_alternative<std::vector<std::uint16_t>>(volume.voxels), index == 1) << type;
    EXPECT_EQ(std::holds_alternative<std::vector<std::int16_t>>(volume.voxels), index == 0) << type;
    EXPECT_EQ(std::holds_alternative<std::vector<float>>(volume.voxels), index == 2) << type;
    EXPECT_EQ(volume.modality, "OT");
  }
}

/// Also of files that are refused while they are read.
TEST(VoxelBytes, LeaveNoFileOpen) {
  const auto open_files = [] { return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}); };
  const std::string data = voxels<std::int16_t>();
  for (const auto& [encoding, bytes] : {std::pair{"raw", data},
                                        {"gzip", packed(data, 31)},
                                        {"ascii", std::string(300, '1')},
                                        {"bzip2", std::string("BZh9")}}) {
    const auto before = open_files();
    verdict_on_voxels(nrrd_in("short", encoding) + bytes);
    verdict_on_voxels(nrrd_in("short", encoding) + bytes.substr(0, bytes.size() / 2));
    EXPECT_EQ(open_files(), before) << encoding;
  }
}

/// In whatever unit a map is written, of either hand, and with its slices along any axis: a voxel lies where the map
/// says, and slices ascend along i x j.
TEST(VoxelLattice, LiesWhereItsMapSaysAtEveryScale) {
  for (const double scale : {1e-4, 1e-2, 0.5, 1.0, 30.0}) {
    for (const double hand : {-1.0, 1.0}) {
      for (const auto& [i, j, k] : {std::array{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}) {
        VoxelMap map;
        map.first = {4, -5, 6};
        map.along[static_cast<std::size_t>(i)] = scale * Vec3(0, 1, 0);
        map.along[static_cast<std::size_t>(j)] = scale * Vec3(0, 0, 2);
        map.along[static_cast<std::size_t>(k)] = scale * Vec3(hand * 3, 0.5, 0.25);  // sheared against both
        const glm::ivec3 size(4, 3, 5);
        VoxelFile file;
        place(VoxelMap(), {2, 2, 9}, file);
        place(map, size, file);
        EXPECT_EQ(file.geometry.slice_positions.size(), static_cast<std::size_t>(size[k]))
            << "only the last map counts";
        EXPECT_EQ(file.axes, (std::array{i, j, k}));
        const Geometry& g = file.geometry;
        EXPECT_GT(glm::dot(glm::cross(g.direction_i, g.direction_j), g.step), 0);
        for (int n = 0; n < size.x * size.y * size.z; ++n) {
          const std::array voxel{n % size.x, n / size.x % size.y, n / (size.x * size.y)};
          Vec3 at = map.first;
          for (std::size_t axis = 0; axis < 3; ++axis) at += static_cast<double>(voxel[axis]) * map.along[axis];
          const auto along = [&](int m) {
            return voxel[static_cast<std::size_t>(file.axes[static_cast<std::size_t>(m)])];
          };
          const int slice = file.reversed ? g.dimensions.z - 1 - along(2) : along(2);
          ASSERT_LT(glm::length(g.to_patient(Vec3(along(0), along(1), slice)) - at), 1e-9 * scale + 1e-12);
        }
      }
    }
  }
}

/// No scan is farther away, or finer.
TEST(VoxelLattice, EndsWhereNoPatientIs) {
  const auto is_held = [](const VoxelMap& map) {
    VoxelFile file;
    try {
      place(map, {2, 2, 2}, file);
    } catch (const DicomError& error) {
      EXPECT_THAT(std::string(error.what()), HasSubstr("farther from the scanner than 100 m"));
      return false;
    }
    return true;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      VoxelMap map;
      map.first[axis] = sign * (farthest_place_mm - 7);  // all edges together are 6 mm
      EXPECT_TRUE(is_held(map));
      map.first[axis] = sign * (farthest_place_mm - 5);
      EXPECT_FALSE(is_held(map));
    }
    VoxelMap map;
    map.along[static_cast<std::size_t>(axis)] *= 0.5 * farthest_place_mm - 3;
    EXPECT_TRUE(is_held(map));
    map.along[static_cast<std::size_t>(axis)] *= 1.001;
    EXPECT_FALSE(is_held(map));
    VoxelMap fine;
    fine.along[static_cast<std::size_t>(axis)] *= 1.01 * least_spacing_mm;
    EXPECT_TRUE(is_held(fine));
    fine.along[static_cast<std::size_t>(axis)] *= 0.98;
    EXPECT_FALSE(is_held(fine));
  }
}

}  // namespace
}  // namespace palpate::io::internal
