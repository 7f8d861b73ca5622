// The limits on the size after inflating.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

#include <array>
#include <chrono>
#include <fstream>

#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/load.h"
#include "io/structures/segment_frames.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "solver/text/testing/sanitized.h"
#include "solver/text/testing/shown.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using palpate::testing::said_when;

/// Deflated up to a byte's end (RFC 1951), so that pieces may follow one another.
std::string deflated(std::string bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string out(bytes.size() / 2 + 4096, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FULL_FLUSH);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

void write_number(std::string& bytes, std::size_t at, std::size_t size, std::uint32_t value) {
  for (std::size_t n = 0; n < size; ++n) bytes[at + n] = static_cast<char>(value >> 8 * n);
}

/// An image of `edge` x `edge` pixels of 16 bits that are all 0, deflated, with `bytes` of pixels behind its header.
void write_zeros(const fs::path& path, std::uint32_t edge, std::uint64_t bytes) {
  TestImage image;
  image.syntax = EXS_DeflatedLittleEndianExplicit;
  write(image, path);
  const std::string meta = bytes_of(path);
  const std::size_t meta_end = 132 + 12 + static_cast<unsigned char>(meta[140]) +
                               256U * static_cast<unsigned char>(meta[141]);  // by its group length
  image.syntax = EXS_LittleEndianExplicit;
  write(image, path);
  std::string header = bytes_of(path);
  header = header.substr(header.find(std::string("\x08\0\x08\0CS", 6)));
  for (const char* attribute : {"\x28\x00\x10\x00US", "\x28\x00\x11\x00US"}) {
    write_number(header, header.find(std::string(attribute, 6)) + 8, 2, edge);
  }
  const std::size_t pixels = header.find(std::string("\xE0\x7F\x10\0OW", 6));
  header.resize(pixels + 12);
  write_number(header, pixels + 8, 4, static_cast<std::uint32_t>(bytes));
  const std::string mib = deflated(std::string(1U << 20, '\0'));
  std::ofstream file(path, std::ios::binary);
  file << meta.substr(0, meta_end) << deflated(header);
  for (std::uint64_t n = 0; n < bytes >> 20; ++n) file << mib;
}

long most_mib_held() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// 4 MB that would come to 3.8 GB.
TEST(Inflation, ABombIsRefusedBeforeItIsInflated) {
  constexpr std::uint32_t edge = 43600;
  const TestFolder folder;
  write_zeros(folder / "bomb", edge, std::uint64_t{2} * edge * edge);
  const auto size = fs::file_size(folder / "bomb");
  ASSERT_LT(size, 5'000'000U);
  const long before = most_mib_held();
  Catalogue found;
  EXPECT_LT(seconds_of([&] { found = find_series(std::array{folder.path()}); }), 5);
  ASSERT_EQ(found.skipped.size(), 1U);
  EXPECT_EQ(found.skipped[0].reason, "damaged: its " + std::to_string(size) +
                                         " bytes are said to inflate to 3625 MiB; if that is right, export it "
                                         "uncompressed");
  if (is_sanitized) return;
  EXPECT_LT(most_mib_held() - before, 64);
}

// An empty slice deflates a thousandfold: what is small anyway is read.
TEST(Inflation, AnEmptySliceIsRead) {
  const TestFolder folder;
  write_zeros(folder / "empty", 4096, std::uint64_t{2} * 4096 * 4096);
  const Catalogue found = find_series(std::array{folder.path()});
  ASSERT_EQ(found.series.size(), 1U);
  const Statistics values = statistics(load(found.series[0]));
  EXPECT_EQ(values.count, 4096U * 4096U);
  EXPECT_EQ(values.maximum, 0);
}

TEST(Inflation, HoldsForSegmentationsToo) {
  const TestFolder folder;
  write_zeros(folder / "bomb", 1024, 3ULL << 20);
  DatasetStart start;
  start.deflated = true;
  const PixelElement element{.value_at = 0, .length = 0xE0000000, .vr = "OW"};
  EXPECT_NE(said_when([&] {
              find_pixels(folder / "bomb", start, element, {.columns = 1024, .rows = 1024, .bits_allocated = 8}, 3);
            }).find("are said to inflate to 3584 MiB"),
            std::string::npos);
}

TEST(Inflation, LimitsGrowWithTheFile) {
  constexpr std::uint64_t mib = 1U << 20;
  EXPECT_NO_THROW(check_inflation(256 * mib, 1));
  EXPECT_THROW(check_inflation(257 * mib, 5 * mib), DicomError);
  EXPECT_NO_THROW(check_inflation(1000 * mib, 20 * mib));
  EXPECT_THROW(check_inflation(8193 * mib, 1000 * mib), DicomError);
}

}  // namespace
}  // namespace palpate::io::internal
