// Fragments of compressed pixels, written item by item (PS3.5 A.4): how they are divided into frames.
#include "io/dicom/fragments.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "io/dicom/input_file.h"
#include "io/errors.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

std::string item(const std::string& bytes) {
  return std::string("\xFE\xFF\x00\xE0", 4) + as_bytes(static_cast<std::uint32_t>(bytes.size())) + bytes;
}
const std::string end_of_items("\xFE\xFF\xDD\xE0\0\0\0\0", 8);

const std::string jpeg("\xFF\xD8\xFF\xE0more", 8), other("12345678", 8);

/// The frames' bytes, of what lies behind 5 bytes of something else; nothing if they do not make up so many.
std::optional<std::vector<std::string>> frames_in(const std::vector<std::uint32_t>& table,
                                                  const std::vector<std::string>& fragments, std::size_t frames) {
  std::string offsets;
  for (const std::uint32_t offset : table) offsets += as_bytes(offset);
  std::string bytes = "12345" + item(offsets);
  for (const std::string& fragment : fragments) bytes += item(fragment);
  const TestFolder folder;
  write_bytes(folder / "a", bytes + end_of_items);
  const InputFile file(folder / "a");
  try {
    std::vector<std::string> all;
    for (const auto& frame : find_fragments(file, 5, frames).frames) {
      std::string& joined = all.emplace_back();
      for (const std::byte byte : read_fragments(file, frame)) joined += static_cast<char>(byte);
    }
    return all;
  } catch (const DicomError&) {
    return std::nullopt;
  }
}

using Frames = std::vector<std::string>;

TEST(Fragments, OneAFrameAreTheFrames) {
  EXPECT_EQ(frames_in({}, {other, "ab"}, 2), (Frames{other, "ab"}));
  EXPECT_EQ(frames_in({}, {other, "ab", jpeg}, 1), (Frames{other + "ab" + jpeg}));
}

// Its offsets count from the first item behind it, to the items and not to their bytes.
TEST(Fragments, TheOffsetTableGoesBeforeWhatTheyLookLike) {
  EXPECT_EQ(frames_in({0, 26}, {other, "ab", other, "cd"}, 2), (Frames{other + "ab", other + "cd"}));
  EXPECT_EQ(frames_in({0, 16}, {jpeg, other, "ab", jpeg}, 2), (Frames{jpeg, other + "ab" + jpeg}));
}

TEST(Fragments, WithoutATableThatFitsTheyBeginWhereAStreamDoes) {
  for (const std::vector<std::uint32_t>& table :
       {std::vector<std::uint32_t>{}, {0}, {0, 8}, {16, 0}, {0, 0}, {16, 34}, {0, 1000}}) {
    EXPECT_EQ(frames_in(table, {jpeg, other, "ab", jpeg}, 2), (Frames{jpeg + other + "ab", jpeg}));
  }
  const std::string jpeg_2000("\xFF\x4F\xFF\x51more", 8), boxes("\0\0\0\x0C\x6A\x50more", 10);
  EXPECT_EQ(frames_in({}, {jpeg_2000, other, boxes, other, "ab"}, 2),
            (Frames{jpeg_2000 + other, boxes + other + "ab"}));
  EXPECT_EQ(frames_in({}, {other, jpeg, "ab", jpeg}, 2), std::nullopt) << "begins with no stream";
  EXPECT_EQ(frames_in({}, {jpeg, other, "ab"}, 2), std::nullopt);
  EXPECT_EQ(frames_in({}, {jpeg, jpeg, jpeg, other}, 2), std::nullopt);
}

}  // namespace
}  // namespace palpate::io::internal
