// Interleaved stacks within a single file are separated by their frames' labels, as they are between files.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

/// The heights of the volumes in a file of frames 1 mm apart, each volume's own.
std::vector<std::vector<double>> stacks_in_one_file(int frames,
                                                    const std::function<void(std::size_t, DcmItem&)>& frame) {
  const TestFolder folder;
  TestImage image;
  image.edit = [&](DcmDataset& d) {
    put(d, DCM_SOPClassUID, std::string(UID_EnhancedCTImageStorage));
    std::vector<double> heights;
    for (int n = 0; n < frames; ++n) heights.push_back(n);
    make_multi_frame(d, heights, frame);
    repeat_pixels(d, static_cast<std::size_t>(frames));
  };
  write(image, folder / "one.dcm");
  std::vector<std::vector<double>> stacks;
  for (const Series& series : find_in(folder).series) {
    auto& heights = stacks.emplace_back();
    for (const Vec3& position : series.geometry.slice_positions) heights.push_back(position.z);
  }
  std::ranges::sort(stacks);
  return stacks;
}

using Stacks = std::vector<std::vector<double>>;

TEST(OneFile, HoldsOneStackWhereItsFramesAreAlike) {
  EXPECT_EQ(stacks_in_one_file(6, [](std::size_t, DcmItem&) {}), (Stacks{{0, 1, 2, 3, 4, 5}}));
}

TEST(OneFile, HoldsAStackOfEachKernel) {
  const auto kernels = [](std::size_t n, DcmItem& item) {
    succeed(group(item, DCM_CTReconstructionSequence)
                .putAndInsertString(DCM_ConvolutionKernel, n % 2 == 0 ? "SOFT" : "BONE"));
  };
  EXPECT_EQ(stacks_in_one_file(8, kernels), (Stacks{{0, 2, 4, 6}, {1, 3, 5, 7}}));
}

TEST(OneFile, HoldsAStackOfEachKind) {
  const auto kinds = [](std::size_t n, DcmItem& item) {
    succeed(
        group(item, DCM_CTImageFrameTypeSequence)
            .putAndInsertString(DCM_FrameType, n % 2 == 0 ? "ORIGINAL\\PRIMARY\\VOLUME" : "DERIVED\\PRIMARY\\VOLUME"));
  };
  EXPECT_EQ(stacks_in_one_file(8, kinds), (Stacks{{0, 2, 4, 6}, {1, 3, 5, 7}}));
}

}  // namespace
}  // namespace palpate::io::internal
