// On which slices the frames of a segmentation lie, and which slices have none.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

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

}  // namespace
}  // namespace palpate::io
