// The order of numbers in a refusal: first the present count, then the required one.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "io/dicom/decode.h"
#include "io/dicom/fragments.h"
#include "io/dicom/input_file.h"
#include "io/errors.h"
#include "io/load.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

std::string refusal_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const DicomError& error) {
    return error.what();
  }
  return "not refused";
}

PixelFormat format_of(int columns, int rows) {
  PixelFormat format;
  format.columns = columns;
  format.rows = rows;
  format.bits_allocated = format.bits_stored = 16;
  format.high_bit = 15;
  return format;
}

std::vector<std::byte> stream_of(const std::vector<int>& numbers) {
  std::vector<std::byte> bytes;
  bytes.reserve(numbers.size());
  for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
  return bytes;
}

// The pixels are the last of the file: 6 x 4 of two bytes.
TEST(CountsInRefusals, ATruncatedFileHasSoManyBytesOfWhatItNeeds) {
  for (const int lost : {1, 2, 17, 47}) {
    const TestFolder folder;
    write_stack(folder.path(), 3);
    const std::filesystem::path cut = folder / "s1.dcm";
    std::filesystem::resize_file(cut, std::filesystem::file_size(cut) - static_cast<std::uintmax_t>(lost));
    const Catalogue found = find_in(folder);
    ASSERT_EQ(found.skipped.size(), 1U);
    EXPECT_EQ(found.skipped[0].reason, "truncated: " + std::to_string(48 - lost) + " of 48 bytes of pixels");
  }
}

// ISO 10918-1 B.2.2: a frame header of lossless JPEG says rows and then columns.
TEST(CountsInRefusals, AJpegImageHasItsOwnSizeAndNotTheFiles) {
  for (const auto& [columns, rows] : {std::array{8, 5}, {6, 5}, {8, 4}, {4, 6}}) {
    const auto jpeg = stream_of({0xFF, 0xD8, 0xFF, 0xC3, 0, 11, 16, 0, rows, 0, columns, 1, 1, 0x11, 0, 0xFF, 0xD9});
    std::vector<std::uint16_t> values(24);
    EXPECT_EQ(refusal_of([&] { decode_frame(UID_JPEGProcess14SV1TransferSyntax, format_of(6, 4), jpeg, values); }),
              "damaged: its JPEG image is " + std::to_string(columns) + " x " + std::to_string(rows) + ", not 6 x 4");
  }
}

// PS3.5 A.4: an empty offset table, then fragments of 4 bytes each that begin no stream.
TEST(CountsInRefusals, SoManyFragmentsDoNotMakeUpSoManyFrames) {
  for (const auto& [fragments, frames] : {std::array{3, 10}, {10, 3}, {1, 2}}) {
    std::string bytes("\xFE\xFF\x00\xE0\0\0\0\0", 8);
    for (int n = 0; n < fragments; ++n) bytes += std::string("\xFE\xFF\x00\xE0\4\0\0\0abcd", 12);
    bytes += std::string("\xFE\xFF\xDD\xE0\0\0\0\0", 8);
    const TestFolder folder;
    write_bytes(folder / "a", bytes);
    const InputFile file(folder / "a");
    EXPECT_EQ(refusal_of([&, count = frames] { find_fragments(file, 0, static_cast<std::size_t>(count)); }),
              std::to_string(fragments) + " compressed fragments do not make up " + std::to_string(frames) + " frames");
  }
}

TEST(CountsInRefusals, SoManyBytesCannotHoldSoManyPixels) {
  EXPECT_EQ(refusal_of([] { check_density(UID_RLELosslessTransferSyntax, format_of(1000, 2000), 3, 70); }),
            "damaged: 70 bytes cannot hold 6000000 pixels");
  EXPECT_EQ(
      refusal_of([] { check_density(UID_DeflatedExplicitVRLittleEndianTransferSyntax, format_of(512, 512), 2, 9); }),
      "damaged: 9 bytes cannot hold 524288 pixels");
}

// How many are wanted, from which one on.
TEST(CountsInRefusals, ASeriesHasSoManySlicesAndNotThoseThatAreWanted) {
  const TestFolder folder;
  write_stack(folder.path(), 5);
  const Series series = only_series_in(folder);
  for (const auto& [first, count] : {std::array{40, 3}, {3, 3}, {-1, 2}, {0, 6}, {0, 0}, {2, -1}}) {
    LoadOptions options;
    options.slices = LoadOptions::Range{first, count};
    EXPECT_EQ(refusal_of([&] { load(series, options); }),
              "series 1.2.3.4 has slices 0 to 4, not " + std::to_string(count) + " from " + std::to_string(first));
  }
  for (const int frame : {-1, 1, 7}) {
    EXPECT_EQ(refusal_of([&, n = frame] { load_frame(series, n); }),
              "series 1.2.3.4 has frames 0 to 0, not " + std::to_string(frame));
  }
}

}  // namespace
}  // namespace palpate::io::internal
