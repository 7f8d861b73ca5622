// Separately deflated frames (1.2.840.10008.1.2.8.1, PS3.5 A.4.13), packed here with zlib.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/load.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int deflated_columns = 7, deflated_rows = 5, deflated_frames = 3;

std::int64_t deflated_truth(int n, int k, int bits, bool is_signed) {
  const std::int64_t range = std::int64_t{1} << bits;
  const std::int64_t value = (range * (n + 36 * k) / 120) % range;
  return is_signed ? value - range / 2 : value;
}

void write_deflated(const TestFolder& folder, int bits, bool is_signed, int damaged = -1) {
  TestImage image{.columns = deflated_columns, .rows = deflated_rows};
  image.syntax = EXS_JPEG2000LosslessOnly;
  image.edit = [&](DcmDataset& d) {
    std::vector<double> heights;
    std::vector<std::vector<Uint8>> coded;
    for (int k = 0; k < deflated_frames; ++k) {
      heights.push_back(2.0 * k);
      std::string bytes;
      for (int n = 0; n < deflated_columns * deflated_rows; ++n) {
        const std::int64_t value = deflated_truth(n, k, bits, is_signed);
        for (int b = 0; b < bits; b += 8) bytes += static_cast<char>(value >> b & 255);
      }
      if (bytes.size() % 2 == 1 && k != 1) bytes += '\0';  // some writers pad a frame before they pack it
      if (k == damaged) bytes.resize(bytes.size() - 3);
      const std::string small = packed(bytes, -15);
      coded.emplace_back(small.begin(), small.end());
    }
    make_multi_frame(d, heights);
    put(d, DCM_BitsAllocated, bits);
    put(d, DCM_BitsStored, bits);
    put(d, DCM_HighBit, bits - 1);
    put(d, DCM_PixelRepresentation, is_signed ? 1 : 0);
    encapsulate(d, EXS_JPEG2000LosslessOnly, coded, 1U << 20);
  };
  write(image, folder / "a.dcm");
  call_deflated_frames(folder / "a.dcm");
}

TEST(DeflatedFrames, HaveTheirValuesOfAnyNumberOfBits) {
  for (const int bits : {8, 16, 32}) {
    for (const bool is_signed : {false, true}) {
      const TestFolder folder;
      write_deflated(folder, bits, is_signed);
      const Volume volume = load(only_series_in(folder));
      EXPECT_THAT(volume.warnings, IsEmpty());
      for (int k = 0; k < deflated_frames; ++k) {
        for (int n = 0; n < deflated_columns * deflated_rows; ++n) {
          const auto expected = static_cast<double>(static_cast<float>(deflated_truth(n, k, bits, is_signed)));
          ASSERT_EQ(volume.value_at(n % deflated_columns, n / deflated_columns, k), expected) << bits << " bits, " << n;
        }
      }
    }
  }
}

TEST(DeflatedFrames, ThatAreTooShortAreNamed) {
  for (const int bits : {8, 16, 32}) {
    const TestFolder folder;
    write_deflated(folder, bits, false, 1);
    const Volume volume = load(only_series_in(folder));
    ASSERT_EQ(volume.warnings.size(), 1U);
    EXPECT_THAT(static_cast<const std::string&>(volume.warnings[0]),
                HasSubstr("damaged: a deflated frame of it is cut, or of another size than the file says"));
    EXPECT_EQ(volume.geometry.dimensions.z, deflated_frames - 1);
  }
}

}  // namespace
}  // namespace palpate::io::internal
