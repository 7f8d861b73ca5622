#pragma once

/// Small segmentations (DICOM SEG), written by DCMTK for tests and as seeds for fuzzing.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/structures/structure.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {

struct TestSegmentation {
  static constexpr int columns = 13;  ///< odd, so that a frame of bits begins within a byte
  static constexpr int rows = 9;

  /// A frame: its segment, its height (mm), and the value of each pixel.
  struct Frame {
    int segment = 1;
    double z = 0;
    std::function<int(int, int)> value;
  };

  std::string type = "BINARY";
  int bits = 1;
  std::vector<std::string> names{"Liver"};
  std::vector<Frame> frames;
  std::function<void(DcmDataset&)> edit = [](DcmDataset&) {};
  E_TransferSyntax syntax = EXS_LittleEndianExplicit;
};

void write(const TestSegmentation& segmentation, const std::filesystem::path& path);

/// The pixels of two boxes of 20 pixels that overlap, as values of a frame.
inline int box(int i, int j) {
  return i >= 3 && i < 8 && j >= 2 && j < 6 ? 1 : 0;
}
inline int other_box(int i, int j) {
  return i >= 6 && i < 11 && j >= 4 && j < 8 ? 1 : 0;
}

inline StructureCatalogue segments_found_in(const TestFolder& folder) {
  return find_structures(std::array{folder.path()});
}

}  // namespace palpate::io::internal
