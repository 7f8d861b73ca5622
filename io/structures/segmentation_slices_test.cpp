// On which slices the frames of a segmentation lie, and which slices have none.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "io/structures/placed_frames.h"
#include "io/structures/structure.h"
#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"

namespace palpate::io {
namespace {

using internal::box;
using internal::group;
using internal::other_box;
using internal::segments_found_in;
using internal::succeed;
using internal::TestFolder;
using internal::TestSegmentation;
using internal::write;

// Positions differ in their last digits from frame to frame, and a slice may have several frames of a segment.
TEST(SegmentationSlices, FramesNearlyAtOnePlaceAreOnOneSlice) {
  // The second of them within the other box; all between them is no part of it.
  const auto two_voxels = [](int i, int j) { return (i == 3 && j == 2) || (i == 10 && j == 7) ? 1 : 0; };
  for (const double off : {-0.004, 0.004}) {
    const TestFolder folder;
    write({.names = {"Liver", "Tumor"},
           .frames = {{1, 0, box},
                      {1, 2, box},
                      {1, 4, box},
                      {2, 2 + off, other_box},
                      {2, 4 + off, other_box},
                      {2, 4 - off, two_voxels}}},
          folder / "seg.dcm");
    const StructureCatalogue catalogue = segments_found_in(folder);
    const StructureMeasures liver = measure(catalogue.structures.at(0)), tumor = measure(catalogue.structures.at(1));
    EXPECT_NEAR(liver.volume_mm3, 3 * 20 * 0.5 * 0.75 * 2, 0.2);
    EXPECT_EQ(tumor.voxels, 20U + 21U);
    EXPECT_NEAR(tumor.box_low_mm.z, 2, 0.01);
    EXPECT_NEAR(tumor.box_high_mm.z, 4, 0.01);
    EXPECT_NEAR(tumor.volume_mm3, 41 * 0.5 * 0.75 * 2, 0.2);
  }
}

// Slices without a frame are there where all distances are multiples of the least one, or of what is said to be the
// spacing, to a twentieth; else the slices are those that have frames.
TEST(SegmentationSlices, WithoutAFrameAreWhereTheirSpacingSays) {
  const auto slice_mm = [](const std::vector<double>& heights, const char* spacing) {
    TestSegmentation segmentation;
    for (const double height : heights) segmentation.frames.push_back({1, height, box});
    segmentation.edit = [&](DcmDataset& dataset) {
      if (*spacing == 0) return;
      DcmItem& shared = group(dataset, DCM_SharedFunctionalGroupsSequence);
      internal::succeed(group(shared, DCM_PixelMeasuresSequence).putAndInsertString(DCM_SpacingBetweenSlices, spacing));
    };
    const TestFolder folder;
    write(segmentation, folder / "seg.dcm");
    const StructureMeasures measures = measure(segments_found_in(folder).structures.at(0));
    return measures.volume_mm3 / (static_cast<double>(*measures.voxels) * 0.5 * 0.75);
  };
  EXPECT_NEAR(slice_mm({0, 2, 8}, ""), 2, 1e-9);
  EXPECT_NEAR(slice_mm({0, 2, 6.18}, ""), (2 + 2.045 + 2.09) / 3, 1e-9) << "half of the way to the slices beside";
  EXPECT_NEAR(slice_mm({0, 2, 6.22}, ""), 6.22 / 2, 1e-9);
  EXPECT_NEAR(slice_mm({0, 6}, ""), 6, 1e-9);
  EXPECT_NEAR(slice_mm({0, 6}, "2"), 2, 1e-9);
  EXPECT_NEAR(slice_mm({0, 6}, "-2"), 2, 1e-9);
  EXPECT_NEAR(slice_mm({5}, "2.5"), 2.5, 1e-9);
}

// At one height all frames begin at one place. From height to height they may not: slices may be sheared.
TEST(SegmentationSlices, FramesBesideEachOtherAreRefused) {
  for (const auto& [place, refused] : {std::pair{"0.4\\0\\2", true},
                                       {"0\\-3\\2", true},
                                       {"0.005\\0.005\\2", false},
                                       {"0\\0\\2", false},
                                       {"3\\-2\\4", false}}) {
    TestSegmentation segmentation{.names = {"Liver", "Tumor"}, .frames = {{1, 0, box}, {1, 2, box}, {2, 2, box}}};
    segmentation.edit = [text = place](DcmDataset& dataset) {
      DcmItem* third = nullptr;
      succeed(dataset.findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, third, 2));
      succeed(group(*third, DCM_PlanePositionSequence).putAndInsertString(DCM_ImagePositionPatient, text));
    };
    const TestFolder folder;
    write(segmentation, folder / "seg.dcm");
    const StructureCatalogue catalogue = segments_found_in(folder);
    EXPECT_EQ(catalogue.skipped.empty() ? "not refused" : std::string(catalogue.skipped.front().reason),
              refused ? "frames of it at one height begin at different places: export each "
                        "segment as a segmentation of its own"
                      : "not refused")
        << place;
  }
}

// Frames that are numbered one after the other have no slice between them; those that are not have as many as there are
// numbers. What the file says of their spacing comes first.
TEST(SegmentationSlices, BetweenNumberedFramesAreThoseOfTheirNumbers) {
  const auto volumes = [](const std::vector<std::pair<double, int>>& slices, const char* spacing) {
    TestSegmentation segmentation;
    for (const auto& [height, number] : slices) segmentation.frames.push_back({1, height, box});
    segmentation.edit = [&](DcmDataset& dataset) {
      for (std::size_t n = 0; n < slices.size(); ++n) {
        DcmItem* frame = nullptr;
        succeed(dataset.findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, frame, static_cast<long>(n)));
        DcmItem& content = group(*frame, DCM_FrameContentSequence);
        succeed(content.putAndInsertUint32(DCM_InStackPositionNumber, static_cast<Uint32>(slices[n].second)));
      }
      if (*spacing == 0) return;
      DcmItem& shared = group(dataset, DCM_SharedFunctionalGroupsSequence);
      succeed(group(shared, DCM_PixelMeasuresSequence).putAndInsertString(DCM_SpacingBetweenSlices, spacing));
    };
    const TestFolder folder;
    write(segmentation, folder / "seg.dcm");
    return measure(segments_found_in(folder).structures.at(0)).volume_mm3 / (20 * 0.5 * 0.75);
  };
  EXPECT_NEAR(volumes({{0, 1}, {1, 2}, {2, 3}, {4, 4}, {6, 5}}, ""), 1 + 1 + 1.5 + 2 + 2, 1e-9);
  EXPECT_NEAR(volumes({{0, 5}, {1, 4}, {3, 3}}, ""), 1 + 1.5 + 2, 1e-9) << "against the heights";
  EXPECT_NEAR(volumes({{0, 1}, {1, 2}, {2, 3}, {4, 5}, {5, 6}}, ""), 5, 1e-9);
  EXPECT_NEAR(volumes({{0, 1}, {1, 2}, {3, 3}}, "1"), 3, 1e-9);
}

/// Frames one above the other, each of its own segment.
std::vector<PlacedFrame> frames_at(const std::vector<std::pair<double, int>>& heights) {
  std::vector<PlacedFrame> frames;
  for (const auto& [height, segment] : heights) {
    frames.push_back({.segment = segment, .placement = {.position = {0, 0, height}}});
  }
  return frames;
}

// A damaged header may ask for any number of slices between frames: the lattice has thousands at most, and then its
// slices are as thick as was said; else they are those that have frames.
TEST(SegmentationSlices, WithoutAFrameAreThousandsAtMost) {
  for (const int count : {2, 3, 6, 40, 400}) {
    for (const double apart : {0.5, 4.0}) {
      for (const double spacing : {1e-5, 0.001, 0.002, 0.01, 0.1, 0.25}) {
        std::vector<std::pair<double, int>> heights;
        for (int n = 0; n < count; ++n) heights.emplace_back(n * apart, 1);
        std::vector<PlacedFrame> frames = frames_at(heights);
        for (PlacedFrame& frame : frames) frame.spacing = spacing;
        const std::vector<int> steps = steps_between(slices_of(frames, {0, 0, 1}), frames);
        const double total = std::accumulate(steps.begin(), steps.end(), 1.0);
        EXPECT_LE(total, 16384) << count << ' ' << apart << ' ' << spacing;
        const double asked = std::round(apart / spacing);
        const bool is_much = asked > 4096 || asked * (count - 1) > 16000;
        for (const int step : steps) ASSERT_EQ(step, is_much ? 1 : asked) << count << ' ' << apart << ' ' << spacing;
      }
    }
  }
}

// Whatever segments the frames of neighboring slices belong to.
TEST(SegmentationSlices, AreFoundInATimeThatGrowsWithTheirFrames) {
  const auto seconds_for = [](int count) {
    std::vector<std::pair<double, int>> heights;
    for (int n = 0; n < count; ++n) heights.emplace_back(n % 2, 1 + n % 2);
    std::vector<PlacedFrame> frames = frames_at(heights);
    for (PlacedFrame& frame : frames) frame.in_stack = 1;
    double least = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < 3; ++turn) {
      const std::clock_t begin = std::clock();  // of the processor: other programs may run beside
      EXPECT_EQ(steps_between(slices_of(frames, {0, 0, 1}), frames), std::vector{1});
      least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return least;
  };
  // Eight times as many: 8 times as long, more where they fit no cache, and 64 with the square.
  EXPECT_LT(seconds_for(40000), 40 * seconds_for(5000));
}

// Some programs count the frames, over all slices and segments: that says nothing of slices.
TEST(SegmentationSlices, AreNotCountedByFramesThatAreCounted) {
  for (const int segments : {2, 3, 5}) {
    for (const double apart : {0.7, 2.0}) {
      for (const bool is_slice_by_slice : {true, false}) {
        std::vector<std::pair<double, int>> heights;
        for (int n = 0; n < 6 * segments; ++n) {
          const int slice = is_slice_by_slice ? n / segments : n % 6;
          heights.emplace_back(slice * apart, 1 + (is_slice_by_slice ? n % segments : n / 6));
        }
        std::vector<PlacedFrame> frames = frames_at(heights);
        for (std::size_t n = 0; n < frames.size(); ++n) frames[n].in_stack = static_cast<int>(n) + 1;
        EXPECT_EQ(steps_between(slices_of(frames, {0, 0, 1}), frames), std::vector(5, 1)) << segments << ' ' << apart;
        // Numbered by their slices, every third of which has a frame, they say so.
        for (PlacedFrame& frame : frames) {
          frame.in_stack = 1 + 3 * static_cast<int>(std::lround(frame.placement.position.z / apart));
        }
        EXPECT_EQ(steps_between(slices_of(frames, {0, 0, 1}), frames), std::vector(5, 3)) << segments << ' ' << apart;
      }
    }
  }
}

// PS3.3 C.7.6.16.2.2: a number counts within its stack alone.
TEST(SegmentationSlices, AreNumberedWithinTheirStack) {
  for (const int between : {2, 3, 7}) {
    for (const int longer : {0, 1, 4}) {
      std::vector<std::pair<double, int>> heights{{0, 1}, {1, 1}};
      for (int n = 0; n < 2 + longer; ++n) heights.emplace_back(1 + between + n, 1);
      std::vector<PlacedFrame> frames = frames_at(heights);
      for (std::size_t n = 0; n < frames.size(); ++n) {
        frames[n].stack = n < 2 ? "1" : "2";
        frames[n].in_stack = static_cast<int>(n < 2 ? n + 1 : n - 1);
      }
      std::vector<int> wanted(frames.size() - 1, 1);
      wanted[1] = between;
      EXPECT_EQ(steps_between(slices_of(frames, {0, 0, 1}), frames), wanted) << between << ' ' << longer;
    }
  }
}

// A slice flatter than a tenth of a pixel is none, whatever the numbers.
TEST(SegmentationSlices, AreNotFlatterThanATenthOfAPixel) {
  for (const double apart : {0.3, 1.0, 5.0}) {
    for (const int number : {2, 3, 9, 40, 4097, 1000000}) {
      std::vector<PlacedFrame> frames = frames_at({{0, 1}, {apart, 1}});
      frames[0].in_stack = 1;
      frames[1].in_stack = number;
      const int steps = steps_between(slices_of(frames, {0, 0, 1}), frames).at(0);
      EXPECT_EQ(steps, apart / (number - 1) > 0.1 ? number - 1 : 1) << apart << ' ' << number;
    }
  }
}

// One slice whose thickness nothing tells is as thick as the scan's voxels, also those of a scan of one slice.
TEST(SegmentationSlices, OneAloneIsAsThickAsTheScansVoxels) {
  const TestFolder folder;
  write({.frames = {{1, 0, box}}}, folder / "seg.dcm");
  const Structure alone = segments_found_in(folder).structures.at(0);
  const double area = 20 * 0.5 * 0.75;
  EXPECT_NEAR(measure(alone).volume_mm3, area, 1e-6);
  for (const double thickness : {0.4, 1.0, 1.7, 5.0}) {
    for (const int count : {1, 2, 9}) {
      for (const double off : {0.0, 0.3}) {  // of a slice
        for (const double side : {-1.0, 1.0}) {
          Geometry scan;
          scan.dimensions = {30, 30, count};
          scan.direction_j = {0, side, 0};
          scan.step = {0, 0, side * thickness};
          for (int k = 0; k < count; ++k) {
            scan.slice_positions.emplace_back(0, 0, side * thickness * (k - count / 2 + off));
          }
          EXPECT_NEAR(measure(alone, &scan).volume_mm3, area * thickness, 1e-6) << thickness << ' ' << count << off;
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
