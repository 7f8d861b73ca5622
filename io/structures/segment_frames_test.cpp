// Frames of a deflated segmentation are inflated once, in order.
#include "io/structures/segment_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"

namespace palpate::io {
namespace {

using internal::TestFolder;
using internal::TestSegmentation;

int value_of(int frame, int i, int j) {
  return (i * 7 + j * 5 + frame * 3) % 4 == 0 ? 1 : 0;
}

struct DeflatedFile {
  TestFolder folder;
  SegmentationPixels pixels;

  DeflatedFile(const std::string& type, int bits, int frames) {
    TestSegmentation segmentation{.type = type, .bits = bits, .syntax = EXS_DeflatedLittleEndianExplicit};
    for (int n = 0; n < frames; ++n) {
      segmentation.frames.push_back({1, 2.0 * n, [n](int i, int j) { return value_of(n, i, j); }});
    }
    internal::write(segmentation, folder / "seg.dcm");
    const internal::InputFile file(folder / "seg.dcm");
    const internal::DatasetStart start = internal::find_dataset(file);
    DcmDataset dataset;
    const auto element = internal::parse_header(file, folder / "seg.dcm", start, dataset);
    internal::PixelFormat format;
    format.columns = TestSegmentation::columns;
    format.rows = TestSegmentation::rows;
    format.bits_allocated = format.bits_stored = bits;
    format.high_bit = bits - 1;
    pixels = find_pixels(folder / "seg.dcm", start, *element, format, static_cast<std::size_t>(frames));
  }
  std::uint64_t bytes() const { return 1ULL * TestSegmentation::columns * TestSegmentation::rows; }
};

TEST(SegmentFrames, ADeflatedFileIsInflatedOnce) {
  for (const auto& [type, bits] : {std::pair{"BINARY", 1}, {"LABELMAP", 8}, {"LABELMAP", 16}}) {
    std::vector<std::uint64_t> inflated;
    for (const int frames : {40, 80}) {
      const DeflatedFile file(type, bits, frames);
      FrameReader reader(file.pixels);
      std::vector<std::uint16_t> values(file.bytes());
      int wrong = 0;
      const auto read = [&](int n) {
        reader.read(static_cast<std::uint32_t>(n), values);
        for (std::size_t at = 0; at < values.size(); ++at) {
          const int i = static_cast<int>(at) % TestSegmentation::columns,
                    j = static_cast<int>(at) / TestSegmentation::columns;
          wrong += values[at] == value_of(n, i, j) ? 0 : 1;
        }
      };
      for (int n = 0; n < frames; ++n) read(n);
      inflated.push_back(reader.inflated_bytes() - file.pixels.at);
      EXPECT_LE(inflated.back(), (file.bytes() * static_cast<std::uint64_t>(frames * bits) + 7) / 8) << type << bits;
      // In any order they are right, too.
      for (const int n : {7, 3, 3, 4, 20, frames - 1, 0}) read(n);
      EXPECT_EQ(wrong, 0) << type << bits;
    }
    EXPECT_LE(inflated[1], 2 * inflated[0] + 1) << "twice as much for twice as many";
  }
}

}  // namespace
}  // namespace palpate::io
