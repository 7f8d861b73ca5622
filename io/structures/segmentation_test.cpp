// Segmentations written by DCMTK, in all their forms, and refusals in words.
#include "io/structures/structure.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"
#include "io/testing/voxel_files.h"

namespace palpate::io {
namespace {

using internal::box;
using internal::group;
using internal::other_box;
using internal::put;
using internal::segments_found_in;
using internal::succeed;
using internal::TestFolder;
using internal::TestImage;
using ::testing::HasSubstr;

using internal::TestSegmentation;
using internal::write;
using Frame = TestSegmentation::Frame;

constexpr int columns = TestSegmentation::columns, rows = TestSegmentation::rows;

StructureCatalogue found_of(const TestSegmentation& segmentation) {
  const TestFolder folder;
  write(segmentation, folder / "seg.dcm");
  StructureCatalogue catalogue = segments_found_in(folder);
  for (Structure& structure : catalogue.structures) {
    if (structure.unfit.empty()) measure(structure);
  }
  return catalogue;
}

std::uint64_t voxels_of(const Structure& structure) {
  return measure(structure).voxels.value_or(0);
}

TEST(Segmentations, AreReadInAnyOrderSparseAndOverlapping) {
  const TestFolder folder;
  // Frames of two segments, shuffled; that at 2 mm is left out of both, for it is empty.
  write({.names = {"Liver", "Tumor"},
         .frames = {{1, 6, box}, {2, 0, other_box}, {1, 0, box}, {2, 6, other_box}, {1, 4, box}}},
        folder / "seg.dcm");
  const StructureCatalogue catalogue = segments_found_in(folder);
  ASSERT_EQ(catalogue.structures.size(), 2U);
  const Structure& liver = catalogue.structures[0];
  EXPECT_EQ(liver.name, "Liver");
  EXPECT_EQ(liver.color, "#ffffff");
  EXPECT_EQ(liver.frame_of_reference_uid, "1.2.3.9");
  EXPECT_EQ(voxels_of(liver), 3U * 20U);
  EXPECT_EQ(voxels_of(catalogue.structures[1]), 2U * 20U);
  EXPECT_DOUBLE_EQ(measure(liver).box_low_mm.z, 0);
  EXPECT_DOUBLE_EQ(measure(liver).box_high_mm.z, 6);
  EXPECT_NEAR(measure(liver).centroid_mm.z, 10.0 / 3, 1e-12);
}

// By its label; where it has none, by what its code means; else by its number.
TEST(Segmentations, EachSegmentHasAName) {
  const TestFolder folder;
  TestSegmentation segmentation{.names = {"Liver", "", ""}, .frames = {{1, 0, box}, {2, 0, box}, {3, 0, box}}};
  segmentation.edit = [](DcmDataset& dataset) {
    for (const unsigned long n : {0UL, 1UL}) {
      DcmItem *segment = nullptr, *code = nullptr;
      succeed(dataset.findAndGetSequenceItem(DCM_SegmentSequence, segment, static_cast<signed long>(n)));
      succeed(segment->findOrCreateSequenceItem(DCM_SegmentedPropertyTypeCodeSequence, code, -2));
      succeed(code->putAndInsertString(DCM_CodeMeaning, "Spleen"));
    }
  };
  write(segmentation, folder / "seg.dcm");
  std::vector<std::string> names;
  for (const Structure& structure : segments_found_in(folder).structures) names.push_back(structure.name);
  EXPECT_EQ(names, (std::vector<std::string>{"Liver", "Spleen", "segment 3"}));
}

TEST(Segmentations, OfFractionsHaveTheirEdgeAtHalf) {
  const TestFolder folder;
  const auto rising = [](int i, int) { return 20 * i; };  // 100 of 200 at column 5
  write({.type = "FRACTIONAL", .bits = 8, .frames = {{1, 0, rising}, {1, 2, rising}}}, folder / "seg.dcm");
  EXPECT_EQ(voxels_of(segments_found_in(folder).structures.at(0)), 2U * rows * (columns - 5));
}

// Nothing up to column 4, 60 of 200 in column 5, all of what follows: the edge lies within column 5.
TEST(FractionsFelt, AreWhereTheirFractionsSay) {
  const auto step = [](int i, int) { return i < 5 ? 0 : (i == 5 ? 60 : 200); };
  const auto edge_of = [&](const char* type) {
    const TestFolder folder;
    TestSegmentation segmentation{.type = "FRACTIONAL", .bits = 8};
    for (int n = 0; n < 24; ++n) segmentation.frames.push_back({1, 2.0 * n, step});
    segmentation.edit = [&](DcmDataset& dataset) { put(dataset, DCM_SegmentationFractionalType, type); };
    write(segmentation, folder / "seg.dcm");
    const Structure structure = segments_found_in(folder).structures.at(0);
    Geometry scan;  // ends with the structure, which runs on through it
    scan.dimensions = {columns, rows, 24};
    scan.spacing_i = 0.75;
    scan.spacing_j = 0.5;
    scan.step = {0, 0, 2};
    for (int n = 0; n < 24; ++n) scan.slice_positions.emplace_back(0, 0, 2 * n);
    DistanceOptions options;
    options.scan = &scan;
    const auto field = load_distance(structure, options);
    const StructureMeasures measures = measure(structure);  // of columns 6 to 12, all rows
    const double spacing = (measures.box_high_mm.x - measures.box_low_mm.x) / 6;
    const double y = 0.5 * (measures.box_low_mm.y + measures.box_high_mm.y);
    double out = measures.box_low_mm.x - 2 * spacing, in = measures.box_low_mm.x;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (in + out);
      (field->sample({middle, y, 23}).mm > 0 ? in : out) = middle;
    }
    return 6 + (in - measures.box_low_mm.x) / spacing;
  };
  EXPECT_NEAR(edge_of("OCCUPANCY"), 5.2, 0.05) << "0.7 of column 5, which ends at 5.5, is outside";
  EXPECT_NEAR(edge_of("PROBABILITY"), 5 + 0.2 / 0.7, 0.05) << "half lies between 0.3 and 1";
}

TEST(Segmentations, OfLabelsHaveOneAFrame) {
  for (const int bits : {8, 16}) {
    const TestFolder folder;
    const auto labels = [](int i, int j) { return box(i, j) != 0 ? 1 : (other_box(i, j) != 0 ? 2 : 0); };
    write({.type = "LABELMAP", .bits = bits, .names = {"Liver", "Spleen"}, .frames = {{0, 0, labels}, {0, 2, labels}}},
          folder / "seg.dcm");
    const StructureCatalogue catalogue = segments_found_in(folder);
    ASSERT_EQ(catalogue.structures.size(), 2U);
    EXPECT_EQ(voxels_of(catalogue.structures[0]), 2U * 20U);
    EXPECT_EQ(voxels_of(catalogue.structures[1]), 2U * (20U - 4U));
  }
}

// 257 and 256 are other labels than 1 and 0, in either order of bytes.
TEST(Segmentations, OfLabelsHoldNumbersOfSixteenBits) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    const TestFolder folder;
    const auto labels = [](int i, int j) {
      return box(i, j) != 0 ? 1 : (other_box(i, j) != 0 ? 257 : i == 0 ? 256 : 0);
    };
    TestSegmentation segmentation{.type = "LABELMAP", .bits = 16, .frames = {{0, 0, labels}, {0, 2, labels}}};
    segmentation.syntax = syntax;
    segmentation.edit = [&](DcmDataset& dataset) {
      std::vector<Uint16> words;
      for (int n = 0; n < 2 * columns * rows; ++n) {
        words.push_back(static_cast<Uint16>(labels(n % columns, n / columns % rows)));
      }
      internal::succeed(
          dataset.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size())));
    };
    write(segmentation, folder / "seg.dcm");
    const Structure liver = segments_found_in(folder).structures.at(0);
    const StructureMeasures measures = measure(liver);
    EXPECT_EQ(measures.voxels, 2U * 20U) << syntax;
    // Columns 3 to 7 and rows 2 to 5.
    EXPECT_NEAR((measures.centroid_mm.x - 0) / 0.75, 5, 1e-9);
    EXPECT_NEAR((measures.centroid_mm.y - 0) / 0.5, 3.5, 1e-9);
  }
}

/// The run-length coder's: one segment, which begins behind its header, as a literal.
std::vector<Uint8> run_length_coded(const std::string& bytes) {
  std::vector<Uint8> coded(64);
  coded[0] = 1;
  coded[4] = 64;
  coded.push_back(static_cast<Uint8>(bytes.size() - 1));
  coded.insert(coded.end(), bytes.begin(), bytes.end());
  return coded;
}

// Bits are packed eight to a byte, the least significant first, before they are run-length coded or deflated (PS3.5
// 8.2.2, 8.2.16, G). Each frame begins with a byte of its own.
TEST(Segmentations, OfBitsAreReadRunLengthCodedAndDeflated) {
  for (const bool deflated : {false, true}) {
    const TestFolder folder;
    TestSegmentation segmentation{.frames = {{1, 0, box}, {1, 2, other_box}}};
    segmentation.syntax = deflated ? EXS_JPEG2000LosslessOnly : EXS_RLELossless;
    segmentation.edit = [&](DcmDataset& dataset) {
      std::vector<std::vector<Uint8>> frames;
      for (const Frame& frame : segmentation.frames) {
        std::string bytes((columns * rows + 7) / 8, '\0');
        for (std::size_t n = 0; n < static_cast<std::size_t>(columns * rows); ++n) {
          const int bit = frame.value(static_cast<int>(n) % columns, static_cast<int>(n) / columns);
          bytes[n / 8] = static_cast<char>(bytes[n / 8] | bit << (n % 8));
        }
        const std::string small = internal::packed(bytes, -15);
        frames.push_back(deflated ? std::vector<Uint8>(small.begin(), small.end()) : run_length_coded(bytes));
      }
      internal::encapsulate(dataset, segmentation.syntax, frames, 1U << 16U);
    };
    write(segmentation, folder / "seg.dcm");
    if (deflated) internal::call_deflated_frames(folder / "seg.dcm");
    const StructureCatalogue catalogue = segments_found_in(folder);
    ASSERT_EQ(catalogue.structures.size(), 1U) << (catalogue.skipped.empty() ? Text() : catalogue.skipped[0].reason);
    const StructureMeasures measures = measure(catalogue.structures[0]);
    EXPECT_EQ(measures.voxels, 20U + 20U);
    EXPECT_NEAR(measures.box_low_mm.x, 0.75 * 3, 1e-9);
    EXPECT_NEAR(measures.box_high_mm.x, 0.75 * 10, 1e-9);
    EXPECT_NEAR(measures.centroid_mm.x, 0.75 * 0.5 * (5 + 8), 1e-9);
    EXPECT_NEAR(measures.centroid_mm.y, 0.5 * 0.5 * (3.5 + 5.5), 1e-9);
  }
}

// Pixels of all frames are of one size, to a thousandth.
TEST(Segmentations, FramesShareTheirPixelsSize) {
  for (const auto& [spacing, fits] :
       {std::pair{"0.5004\\0.75", true}, {"0.5006\\0.75", false}, {"0.5\\0.7507", true}, {"0.5\\0.7508", false}}) {
    const TestFolder folder;
    TestSegmentation segmentation{.frames = {{1, 0, box}, {1, 2, box}}};
    segmentation.edit = [text = spacing](DcmDataset& dataset) {
      DcmItem* second = nullptr;
      internal::succeed(dataset.findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, second, 1));
      internal::succeed(group(*second, DCM_PixelMeasuresSequence).putAndInsertString(DCM_PixelSpacing, text));
    };
    write(segmentation, folder / "seg.dcm");
    EXPECT_EQ(segments_found_in(folder).skipped.empty(), fits) << spacing;
  }
}

TEST(Segmentations, AreReadCompressed) {
  const TestFolder folder;
  TestSegmentation segmentation{.type = "LABELMAP", .bits = 8, .frames = {{0, 0, box}, {0, 2, box}}};
  segmentation.syntax = EXS_JPEG2000LosslessOnly;
  segmentation.edit = [](DcmDataset& dataset) {
    internal::encapsulate(
        dataset, EXS_JPEG2000LosslessOnly,
        {internal::jpeg2000(columns, rows, 8, false, box), internal::jpeg2000(columns, rows, 8, false, box)},
        1U << 16U);
  };
  write(segmentation, folder / "seg.dcm");
  const StructureCatalogue catalogue = segments_found_in(folder);
  ASSERT_EQ(catalogue.structures.size(), 1U) << (catalogue.skipped.empty() ? Text() : catalogue.skipped[0].reason);
  EXPECT_EQ(voxels_of(catalogue.structures[0]), 2U * 20U);
}

std::string refusal_of(const TestSegmentation& segmentation) {
  try {
    const StructureCatalogue catalogue = found_of(segmentation);
    return catalogue.skipped.empty() ? "not refused" : catalogue.skipped.front().reason.c_str();
  } catch (const DicomError& error) {
    return error.what();
  }
}

TEST(Segmentations, AreRefusedInWords) {
  const auto none = [](int, int) { return 0; };
  const std::vector<Frame> frames{{1, 0, box}, {1, 2, box}};
  EXPECT_THAT(refusal_of({.frames = {{1, 0, none}}}),
              HasSubstr("seg.dcm: SEG \"Liver\" (1) cannot be read: it is empty: no voxel is inside"));
  const auto edited = [&](const std::function<void(DcmDataset&)>& edit) {
    return refusal_of({.frames = frames, .edit = edit});
  };
  EXPECT_EQ(edited([](DcmDataset& d) { d.putAndInsertUint32(DCM_TotalPixelMatrixColumns, 4000); }),
            "it outlines a microscope's slide, not a scan: it cannot be felt");
  EXPECT_EQ(edited([](DcmDataset& d) { d.findAndDeleteElement(DCM_PixelData); }), "it has no pixels: export it again");
  EXPECT_EQ(edited([](DcmDataset& d) { d.findAndDeleteElement(DCM_Rows); }),
            "it has no pixels: Rows or Columns is missing");
  EXPECT_EQ(edited([](DcmDataset& d) { put(d, DCM_BitsAllocated, 3); }),
            "its pixels have 3 bits: a segmentation has 1, 8 or 16");
  EXPECT_EQ(edited([](DcmDataset& d) { put(d, DCM_SegmentationType, "OTHER"); }),
            "its segmentation type \"OTHER\" is unknown; there are: BINARY, FRACTIONAL, LABELMAP");
  EXPECT_EQ(edited([](DcmDataset& d) { d.findAndDeleteElement(DCM_SegmentSequence); }),
            "it names no segments (SegmentSequence): export it again");
  EXPECT_EQ(edited([](DcmDataset& d) { d.findAndDeleteElement(DCM_PerFrameFunctionalGroupsSequence); }),
            "it does not say where its frames lie (PerFrameFunctionalGroupsSequence): export it again");
  EXPECT_EQ(edited([](DcmDataset& d) { put(d, DCM_NumberOfFrames, "5"); }),
            "it gives the positions of only 2 of its 5 frames: export it again");
  EXPECT_EQ(
      edited([](DcmDataset& d) { group(d, DCM_SharedFunctionalGroupsSequence).clear(); }),
      "a frame of it does not say where it lies in the patient (position, orientation or spacing): export it again");
  EXPECT_EQ(edited([](DcmDataset& d) { put(d, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.66.5"); }),
            "it holds surfaces (Surface Segmentation), which are not read: export it as SEG");
  const auto of_frame = [](DcmDataset& d) -> DcmItem& { return group(d, DCM_PerFrameFunctionalGroupsSequence); };
  EXPECT_EQ(edited([&](DcmDataset& d) { of_frame(d).findAndDeleteElement(DCM_SegmentIdentificationSequence); }),
            "a frame of it does not say to which segment it belongs: export it again");
  EXPECT_EQ(edited([&](DcmDataset& d) {
              group(of_frame(d), DCM_PixelMeasuresSequence).putAndInsertString(DCM_PixelSpacing, "2\\2");
            }),
            "its frames have several orientations or pixel sizes: export each as a segmentation of its own");
  EXPECT_EQ(refusal_of({.type = "FRACTIONAL",
                        .bits = 8,
                        .frames = frames,
                        .edit = [](DcmDataset& d) { put(d, DCM_MaximumFractionalValue, 0); }}),
            "its MaximumFractionalValue is not above 0: export it again");
  EXPECT_THAT(edited([](DcmDataset& d) { d.putAndInsertUint8Array(DCM_PixelData, nullptr, 0); }),
              HasSubstr("bytes of pixels"));
}

}  // namespace
}  // namespace palpate::io
