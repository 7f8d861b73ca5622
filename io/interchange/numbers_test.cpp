// Every type of number in the three formats, in both byte orders: its least and largest values, which together identify
// size and sign.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

constexpr int number_count = nx * ny * nz;

template <typename T>
T number_of_voxel(int n) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>((n % 2 == 0 ? -1.25 : 1e-3) * n * n);
  } else {
    using Limits = std::numeric_limits<T>;
    const auto step = static_cast<T>(n);
    return static_cast<T>(n % 3 == 0 ? Limits::lowest() + step : n % 3 == 1 ? Limits::max() - step : step);
  }
}

template <typename T>
std::string all_numbers(bool big) {
  std::string bytes;
  for (int n = 0; n < number_count; ++n) bytes += as_bytes(number_of_voxel<T>(n), big);
  return bytes;
}

/// Its voxels lie in the file's order along the patient's axes: integers of up to 16 bits are exact, others as floats.
template <typename T>
void expect_numbers(const std::filesystem::path& file) {
  const Volume volume = only_volume(file);
  ASSERT_EQ(volume.geometry.dimensions, glm::ivec3(nx, ny, nz));
  for (int n = 0; n < number_count; ++n) {
    const auto expected = static_cast<double>(static_cast<float>(number_of_voxel<T>(n)));
    ASSERT_EQ(volume.value_at(n % nx, n / nx % ny, n / (nx * ny)), expected) << n;
  }
}

template <typename T>
void expect_of_every_format(std::int16_t nifti, const std::vector<std::string>& nrrd,
                            const std::vector<std::string>& meta) {
  const TestFolder folder;
  const Rows along_the_patient{{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}}};
  for (const bool big : {false, true}) {
    SCOPED_TRACE(::testing::Message() << "NIfTI " << nifti << ", big-endian " << big);
    const std::string data = all_numbers<T>(big);
    write_bytes(folder / "a.nii", Nifti(big).sform(along_the_patient).put(70, nifti).bytes() + data);
    expect_numbers<T>(folder / "a.nii");
    for (const std::string& word : nrrd) {
      SCOPED_TRACE(word);
      write_bytes(folder / "a.nrrd", "NRRD0004\ntype: " + word +
                                         "\ndimension: 3\nsizes: 4 3 5\nspace: LPS\nspace directions: (1,0,0) (0,1,0) "
                                         "(0,0,1)\nspace origin: (0,0,0)\nencoding: raw\nendian: " +
                                         (big ? "big" : "little") + "\n\n" + data);
      expect_numbers<T>(folder / "a.nrrd");
    }
    for (const std::string& word : meta) {
      SCOPED_TRACE(word);
      for (const std::string order : {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}) {
        write_bytes(folder / "a.mha", "NDims = 3\nDimSize = 4 3 5\n" + order + " = " + (big ? "True" : "False") +
                                          "\nElementType = " + word + "\nElementDataFile = LOCAL\n" + data);
        expect_numbers<T>(folder / "a.mha");
      }
    }
  }
}

TEST(InterchangeNumbers, OfEightBits) {
  expect_of_every_format<std::uint8_t>(2, {"uchar", "unsigned char", "uint8", "uint8_t"}, {"MET_UCHAR"});
  expect_of_every_format<std::int8_t>(256, {"signed char", "int8", "int8_t"}, {"MET_CHAR", "MET_ASCII_CHAR"});
}

TEST(InterchangeNumbers, OfSixteenBits) {
  expect_of_every_format<std::int16_t>(4, {"short", "short int", "signed short", "int16", "int16_t"}, {"MET_SHORT"});
  expect_of_every_format<std::uint16_t>(512, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"},
                                        {"MET_USHORT"});
}

TEST(InterchangeNumbers, OfThirtyTwoBits) {
  expect_of_every_format<std::int32_t>(8, {"int", "signed int", "int32", "int32_t"}, {"MET_INT", "MET_LONG"});
  expect_of_every_format<std::uint32_t>(768, {"uint", "unsigned int", "uint32", "uint32_t"}, {"MET_UINT", "MET_ULONG"});
  expect_of_every_format<float>(16, {"float"}, {"MET_FLOAT"});
}

TEST(InterchangeNumbers, OfSixtyFourBits) {
  expect_of_every_format<std::int64_t>(1024, {"longlong", "long long", "int64", "int64_t"}, {"MET_LONG_LONG"});
  expect_of_every_format<std::uint64_t>(1280, {"ulonglong", "uint64", "uint64_t"}, {"MET_ULONG_LONG"});
  expect_of_every_format<double>(64, {"double"}, {"MET_DOUBLE"});
}

}  // namespace
}  // namespace palpate::io::internal
