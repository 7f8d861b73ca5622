// High-Throughput JPEG 2000, which is not decoded.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "io/dicom/decode.h"
#include "io/load.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::IsEmpty;

constexpr int columns = 12, rows = 8;

// An image as OpenJPH 0.9.0 codes it: ojph_compress -num_decomps 2 -reversible true.
constexpr const char* lossless =
    "ff4fff51002940000000000c0000000800000000000000000000000c00000008000000000000000000010b0101ff500008000200000007ff"
    "52000c00020001000204044001ff5c000a2070787878707078ff64001600014f70656e4a50482056657220302e392e302eff90000a000000"
    "0000680001ff93c0015e49b0d9e9b643c6d3f90065037b3600c0009e0005684425ea828b7400777cdde1eb8eaf0042037eb600c001550005"
    "bc56ac58b1f2da72027500dd7b77777777771076107610761076107610fe000004000018f86a31bb00ffd9";
std::vector<Uint8> from_hex(const std::string& hex) {
  std::vector<Uint8> bytes;
  for (std::size_t n = 0; n + 1 < hex.size(); n += 2) {
    bytes.push_back(static_cast<Uint8>(std::strtoul(hex.substr(n, 2).c_str(), nullptr, 16)));
  }
  return bytes;
}

// DCMTK does not know the syntax: it writes JPEG 2000, and the file's meta information is changed (PS3.10, 7.1).
void rename_syntax(const std::filesystem::path& path, std::string uid) {
  std::string bytes = bytes_of(path);
  if (uid.size() % 2 != 0) uid.push_back('\0');
  constexpr std::size_t group_length = 128 + 4 + 8, header = 8;
  const std::size_t at = bytes.find(std::string("\2\0\x10\0UI", 6));
  ASSERT_NE(at, std::string::npos);
  const auto before = static_cast<std::size_t>(bytes[at + 6]);
  bytes.replace(at + header, before, uid);
  bytes[at + 6] = static_cast<char>(uid.size());
  bytes[group_length] = static_cast<char>(bytes[group_length] + static_cast<char>(uid.size() - before));
  write_bytes(path, bytes);
}

// Two copies of an image that is not decoded, and whose pixels would lie beyond its end: the scan beside it is read.
TEST(Htj2k, CopiesOfWhatIsNotDecodedAreNotCompared) {
  const TestFolder folder;
  for (const char* const name : {"a", "b"}) {
    std::filesystem::create_directory(folder / name);
    write_stack(folder / name, 1, [&](int, TestImage& image) {
      image.series = "1.2.9";
      image.instance = "1.2.9.1";
      image.columns = columns;
      image.rows = rows;
      image.syntax = EXS_JPEG2000LosslessOnly;
      image.edit = [&](DcmDataset& d) {
        encapsulate(d, EXS_JPEG2000LosslessOnly, {from_hex(lossless)}, 1U << 20);
        put(d, DCM_Rows, 1000);
      };
    });
    rename_syntax(folder / name / "s0.dcm", "1.2.840.10008.1.2.4.204");
  }
  write_stack(folder.path(), 4);
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, ::testing::Not(IsEmpty()));
  EXPECT_TRUE(found.series[0].usable);
  EXPECT_EQ(load(found.series[0]).value_at(3, 2, 1), 132);
}

// PS3.6 annex A. OpenJPEG 2.5.0 and OpenJPH 0.9.0 decode it, but both assert what a damaged stream breaks, which ends
// the program. The module's README has the figures.
TEST(Htj2k, IsRefusedByItsName) {
  for (const char* const uid : {"1.2.840.10008.1.2.4.201", "1.2.840.10008.1.2.4.202", "1.2.840.10008.1.2.4.203"}) {
    EXPECT_FALSE(can_decode(uid));
    EXPECT_EQ(
        why_not_decoded(uid),
        "it is compressed by HTJ2K (High-Throughput JPEG 2000), which Palpate does not read: export it uncompressed");
  }
}

}  // namespace
}  // namespace palpate::io::internal
