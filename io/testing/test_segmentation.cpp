#include "io/testing/test_segmentation.h"

#include <array>
#include <utility>

#include "io/testing/test_image.h"

namespace palpate::io::internal {

namespace {

std::vector<Uint8> packed(const TestSegmentation& segmentation) {
  std::vector<Uint8> bytes;
  std::size_t bit = 0;
  for (const TestSegmentation::Frame& frame : segmentation.frames) {
    for (int j = 0; j < TestSegmentation::rows; ++j) {
      for (int i = 0; i < TestSegmentation::columns; ++i, ++bit) {
        const int value = frame.value(i, j);
        if (segmentation.bits == 8) {
          bytes.push_back(static_cast<Uint8>(value));
        } else if (segmentation.bits == 16) {
          bytes.push_back(static_cast<Uint8>(value & 0xFF));
          bytes.push_back(static_cast<Uint8>(value >> 8));
        } else {
          if (bit % 8 == 0) bytes.push_back(0);
          bytes.back() = static_cast<Uint8>(bytes.back() | (value << (bit % 8)));
        }
      }
    }
  }
  if (bytes.size() % 2 != 0) bytes.push_back(0);
  return bytes;
}

}  // namespace

void write(const TestSegmentation& segmentation, const std::filesystem::path& path) {
  TestImage image{.columns = TestSegmentation::columns, .rows = TestSegmentation::rows};
  image.syntax = segmentation.syntax;
  std::vector<double> heights;
  for (const TestSegmentation::Frame& frame : segmentation.frames) heights.push_back(frame.z);
  image.edit = [&](DcmDataset& dataset) {
    make_multi_frame(dataset, heights, [&](std::size_t n, DcmItem& item) {
      if (segmentation.type == "LABELMAP") return;
      group(item, DCM_SegmentIdentificationSequence)
          .putAndInsertUint16(DCM_ReferencedSegmentNumber, static_cast<Uint16>(segmentation.frames[n].segment));
    });
    put(dataset, DCM_SOPClassUID,
        segmentation.type == "LABELMAP" ? "1.2.840.10008.5.1.4.1.1.66.7" : "1.2.840.10008.5.1.4.1.1.66.4");
    put(dataset, DCM_FrameOfReferenceUID, "1.2.3.9");
    put(dataset, DCM_SegmentationType, segmentation.type);
    put(dataset, DCM_MaximumFractionalValue, 200);
    for (const auto& [tag, value] :
         {std::pair{DCM_BitsAllocated, segmentation.bits}, std::pair{DCM_BitsStored, segmentation.bits},
          std::pair{DCM_HighBit, segmentation.bits - 1}}) {
      put(dataset, tag, value);
    }
    for (std::size_t n = 0; n < segmentation.names.size(); ++n) {
      DcmItem* item = nullptr;
      succeed(dataset.findOrCreateSequenceItem(DCM_SegmentSequence, item, -2));
      item->putAndInsertUint16(DCM_SegmentNumber, static_cast<Uint16>(n + 1));
      item->putAndInsertString(DCM_SegmentLabel, segmentation.names[n].c_str());
      item->putAndInsertString(DCM_RecommendedDisplayCIELabValue, "65535\\32896\\32896");
    }
    const std::vector<Uint8> bytes = packed(segmentation);
    succeed(dataset.putAndInsertUint8Array(DCM_PixelData, bytes.data(), static_cast<unsigned long>(bytes.size())));
    segmentation.edit(dataset);
  };
  write(image, path);
}

}  // namespace palpate::io::internal
