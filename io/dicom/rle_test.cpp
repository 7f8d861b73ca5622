// Run lengths of PS3.5 annex G, packed here by hand: each type of code at its shortest and longest, and input that a
// decoder must skip or refuse.
#include <gtest/gtest.h>

#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"

namespace palpate::io::internal {
namespace {

using Bytes = std::vector<std::uint8_t>;

PixelFormat format_of(int pixels, int bits) {
  PixelFormat format;
  format.columns = pixels;
  format.rows = 1;
  format.bits_allocated = format.bits_stored = bits;
  format.high_bit = bits - 1;
  return format;
}

/// The header of 64 bytes, then the segments.
std::vector<std::byte> coded(const std::vector<Bytes>& segments) {
  std::vector<std::byte> bytes(64);
  const auto put = [&](std::size_t at, std::size_t number) {
    for (std::size_t n = 0; n < 4; ++n) bytes[at + n] = static_cast<std::byte>(number >> (8 * n) & 0xFFU);
  };
  put(0, segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    put(4 + 4 * s, bytes.size());
    for (const std::uint8_t byte : segments[s]) bytes.push_back(static_cast<std::byte>(byte));
  }
  return bytes;
}

/// Two bytes alone, as a literal; 128, which says nothing; runs of 2 and of 128; a literal of 128.
Bytes packed_row() {
  Bytes packed{1, 200, 7, 128, 255, 33, 128, 129, 44, 127};
  for (int n = 0; n < 128; ++n) packed.push_back(static_cast<std::uint8_t>(n + 90));
  return packed;
}

Bytes unpacked_row() {
  Bytes row{200, 7, 33, 33};
  for (int n = 0; n < 128; ++n) row.push_back(44);
  for (int n = 0; n < 128; ++n) row.push_back(static_cast<std::uint8_t>(n + 90));
  return row;
}

TEST(RunLengths, OfEveryCodeAreUnpacked) {
  const Bytes row = unpacked_row();
  std::vector<std::uint16_t> values(row.size());
  decode_rle(format_of(static_cast<int>(row.size()), 8), coded({packed_row()}), values);
  for (std::size_t n = 0; n < row.size(); ++n) ASSERT_EQ(values[n], row[n]) << n;
}

TEST(RunLengths, HoldTheMoreSignificantBytesFirst) {
  const Bytes row = unpacked_row();
  // Of as many pixels the low bytes: all 5, in runs of 128, 128 and 4.
  std::vector<std::uint16_t> values(row.size());
  decode_rle(format_of(static_cast<int>(row.size()), 16), coded({packed_row(), {129, 5, 129, 5, 253, 5, 0}}), values);
  for (std::size_t n = 0; n < row.size(); ++n) ASSERT_EQ(values[n], 256 * row[n] + 5) << n;
}

std::string refusal(const PixelFormat& format, std::vector<std::byte> bytes) {
  std::vector<std::uint16_t> values(static_cast<std::size_t>(format.columns));
  try {
    decode_rle(format, bytes, values);
  } catch (const DicomError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(RunLengths, ThatDoNotFitAreRefused) {
  const std::string rle = "damaged: its RLE segments ";
  EXPECT_EQ(refusal(format_of(4, 8), coded({{253, 9}})), "not refused");
  EXPECT_EQ(refusal(format_of(4, 8), coded({{252, 9}})), rle + "do not fit the image");
  EXPECT_EQ(refusal(format_of(4, 8), coded({{254, 9}})), rle + "end early");
  EXPECT_EQ(refusal(format_of(4, 8), coded({{3, 1, 2, 3}})), rle + "do not fit the image");
  EXPECT_EQ(refusal(format_of(4, 8), coded({{253}})), rle + "do not fit the image");
  EXPECT_EQ(refusal(format_of(4, 16), coded({{253, 9}})), rle + "are not one for each byte of a pixel");
  EXPECT_EQ(refusal(format_of(4, 8), std::vector<std::byte>(63)), rle + "are missing");
  for (const int start : {63, 67}) {
    auto bytes = coded({{253, 9}});
    bytes[4] = static_cast<std::byte>(start);
    EXPECT_EQ(refusal(format_of(4, 8), bytes), rle + "lie outside the file") << start;
  }
}

}  // namespace
}  // namespace palpate::io::internal
