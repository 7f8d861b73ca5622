// Reading a JPEG stream's markers before decoding, byte by byte: ISO 10918-1 annex B.
#include <gtest/gtest.h>

#include <cstddef>
#include <initializer_list>
#include <random>
#include <span>
#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"

namespace palpate::io::internal {
namespace {

/// A stream as it is put together: markers and what follows them.
class JpegBytes {
 public:
  JpegBytes() { add({0xFF, 0xD8}); }
  JpegBytes& add(std::initializer_list<int> bytes) {
    for (const int byte : bytes) bytes_.push_back(static_cast<std::byte>(byte));
    return *this;
  }
  JpegBytes& add(const std::vector<int>& bytes) {
    for (const int byte : bytes) bytes_.push_back(static_cast<std::byte>(byte));
    return *this;
  }
  JpegBytes& segment(int marker, const std::vector<int>& content) {
    const auto length = static_cast<int>(content.size()) + 2;
    return add({0xFF, marker, length >> 8, length & 0xFF}).add(content);
  }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

std::vector<int> frame_of(int precision, int rows, int columns) {
  return {precision, rows >> 8, rows & 0xFF, columns >> 8, columns & 0xFF, 1, 1, 0x11, 0};
}

// Table B.1: C0 to CF begin a frame but for C4, C8 and CC.
TEST(JpegStream, SaysItsSizeInAnyKindOfFrame) {
  for (int marker = 0xC0; marker <= 0xCF; ++marker) {
    JpegBytes stream;
    stream.segment(0xE0, {1, 2, 3, 4, 5}).add({0xFF, 0xFF}).segment(0xDB, std::vector<int>(65, 0xC0));
    stream.segment(marker, frame_of(12, 0x1234, 0x0567)).segment(0xC3, frame_of(8, 7, 9));
    const auto found = jpeg_frame(stream.bytes());
    ASSERT_TRUE(found) << marker;
    const bool is_frame = marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    EXPECT_EQ(found->precision, is_frame ? 12 : 8) << marker;
    EXPECT_EQ(found->rows, is_frame ? 0x1234 : 7) << marker;
    EXPECT_EQ(found->columns, is_frame ? 0x0567 : 9) << marker;
  }
}

TEST(JpegStream, ThatEndsOrBreaksOffSaysNoSize) {
  JpegBytes whole;
  whole.segment(0xE1, {9, 9}).segment(0xC1, frame_of(8, 5, 6));
  EXPECT_TRUE(jpeg_frame(whole.bytes()));
  for (std::size_t kept = 0; kept < 2 + 6 + 9; ++kept) EXPECT_FALSE(jpeg_frame(whole.bytes().first(kept))) << kept;
  EXPECT_TRUE(jpeg_frame(whole.bytes().first(2 + 6 + 9))) << "the size is all there";
  EXPECT_FALSE(jpeg_frame(JpegBytes().segment(0xE1, {9, 9}).add({0x12}).segment(0xC1, frame_of(8, 5, 6)).bytes()))
      << "no marker where one should be";
  EXPECT_FALSE(jpeg_frame({}));
}

/// B.2.4.2: class and place, sixteen counts, then the symbols by their codes' lengths.
std::vector<int> huffman_table(int class_and_place, const std::vector<int>& counts, const std::vector<int>& symbols) {
  std::vector<int> table{class_and_place};
  for (std::size_t n = 0; n < 16; ++n) table.push_back(n < counts.size() ? counts[n] : 0);
  table.insert(table.end(), symbols.begin(), symbols.end());
  return table;
}

bool are_sound(const JpegBytes& stream, std::size_t most) {
  try {
    check_huffman_tables(stream.bytes(), most);
  } catch (const DicomError&) {
    return false;
  }
  return true;
}

std::vector<int> joined(std::vector<int> a, const std::vector<int>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(JpegStream, TablesOfDifferencesHoldNoMoreBitsThanThereAre) {
  for (const int most : {11, 16}) {
    const auto bits = static_cast<std::size_t>(most);
    const std::vector<int> good = huffman_table(0x00, {0, 2, 1}, {0, 5, most});
    const std::vector<int> bad =
        huffman_table(0x01, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2}, {0, 1, most + 1});
    const std::vector<int> others = huffman_table(0x11, {1, 1}, {0xF0, 0xFF});  // of AC coefficients: runs and bits
    const auto of = [&](const std::vector<int>& content) { return JpegBytes().segment(0xC4, content); };
    EXPECT_TRUE(are_sound(of(good), bits));
    EXPECT_TRUE(are_sound(of(others), bits));
    EXPECT_TRUE(are_sound(of(joined(others, good)), bits));
    EXPECT_FALSE(are_sound(of(bad), bits));
    EXPECT_FALSE(are_sound(of(joined(good, bad)), bits)) << "behind another table of its segment";
    EXPECT_FALSE(are_sound(of(joined(others, bad)), bits));
    EXPECT_FALSE(are_sound(of(joined(bad, others)), bits));
    // Any other segment may hold these bytes; and the table comes wherever it likes.
    EXPECT_TRUE(are_sound(JpegBytes().segment(0xFE, joined({0xFF, 0xC4, 0, 40}, bad)), bits));
    for (const std::vector<int>& coded : {std::vector<int>{},
                                          {0x12, 0xFF, 0x00, 0x34},
                                          {0xFF, 0xD3, 0x56},
                                          {0xFF, 0xFF},
                                          {0xFF, 0xD8},
                                          {0xFF, 0xD0, 0xFF, 0xD7}}) {
      EXPECT_FALSE(are_sound(JpegBytes().segment(0xE0, {1, 2, 3}).add(coded).segment(0xC4, bad), bits));
      EXPECT_TRUE(are_sound(JpegBytes().segment(0xE0, {1, 2, 3}).add(coded).segment(0xC4, good), bits));
    }
  }
}

// Whatever the bytes, it comes to an end within them.
TEST(JpegStream, OfNoiseIsReadToItsEnd) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 3000; ++trial) {
    JpegBytes stream;
    std::vector<int> noise;
    for (auto n = random() % 80; n > 0; --n) {
      noise.push_back(random() % 3 == 0 ? 0xFF : random() % 3 == 0 ? 0xC4 : static_cast<int>(random() % 256));
    }
    stream.add(noise);
    are_sound(stream, 16);
    jpeg_frame(stream.bytes());
  }
}

}  // namespace
}  // namespace palpate::io::internal
