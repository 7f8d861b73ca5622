// Segmentations and contours written by DCMTK, in every form they come in, and what is refused in words.
#include "io/structures/structure.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "io/errors.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io {
namespace {

using internal::group;
using internal::put;
using internal::TestFolder;
using internal::TestImage;
using ::testing::HasSubstr;

constexpr int columns = 13;  // odd, so that a frame of bits begins within a byte
constexpr int rows = 9;

/// A frame: of which segment, at which height, and which of its pixels are set.
struct Frame {
  int segment = 1;
  double z = 0;
  std::function<int(int, int)> value;
};

struct TestSegmentation {
  std::string type = "BINARY";
  int bits = 1;
  std::vector<std::string> names{"Liver"};
  std::vector<Frame> frames;
  std::function<void(DcmDataset&)> edit = [](DcmDataset&) {};
  E_TransferSyntax syntax = EXS_LittleEndianExplicit;
};

int box(int i, int j) {
  return i >= 3 && i < 8 && j >= 2 && j < 6 ? 1 : 0;
}
int other_box(int i, int j) {
  return i >= 6 && i < 11 && j >= 4 && j < 8 ? 1 : 0;
}

std::vector<Uint8> packed(const TestSegmentation& segmentation) {
  std::vector<Uint8> bytes;
  std::size_t bit = 0;
  for (const Frame& frame : segmentation.frames) {
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i, ++bit) {
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

void write(const TestSegmentation& segmentation, const std::filesystem::path& path) {
  TestImage image{.columns = columns, .rows = rows};
  image.syntax = segmentation.syntax;
  std::vector<double> heights;
  for (const Frame& frame : segmentation.frames) heights.push_back(frame.z);
  image.edit = [&](DcmDataset& dataset) {
    internal::make_multi_frame(dataset, heights, [&](std::size_t n, DcmItem& item) {
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
      internal::succeed(dataset.findOrCreateSequenceItem(DCM_SegmentSequence, item, -2));
      item->putAndInsertUint16(DCM_SegmentNumber, static_cast<Uint16>(n + 1));
      item->putAndInsertString(DCM_SegmentLabel, segmentation.names[n].c_str());
      item->putAndInsertString(DCM_RecommendedDisplayCIELabValue, "65535\\32896\\32896");
    }
    const std::vector<Uint8> bytes = packed(segmentation);
    internal::succeed(
        dataset.putAndInsertUint8Array(DCM_PixelData, bytes.data(), static_cast<unsigned long>(bytes.size())));
    segmentation.edit(dataset);
  };
  internal::write(image, path);
}

StructureCatalogue structures_in(const TestFolder& folder) {
  return find_structures(std::array{folder.path()});
}

StructureCatalogue found_of(const TestSegmentation& segmentation) {
  const TestFolder folder;
  write(segmentation, folder / "seg.dcm");
  StructureCatalogue catalogue = structures_in(folder);
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
  const StructureCatalogue catalogue = structures_in(folder);
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

TEST(Segmentations, OfFractionsHaveTheirEdgeAtHalf) {
  const TestFolder folder;
  const auto rising = [](int i, int) { return 20 * i; };  // 100 of 200 at column 5
  write({.type = "FRACTIONAL", .bits = 8, .frames = {{1, 0, rising}, {1, 2, rising}}}, folder / "seg.dcm");
  EXPECT_EQ(voxels_of(structures_in(folder).structures.at(0)), 2U * rows * (columns - 5));
}

// Nothing up to column 4, 60 of 200 in column 5, all of what follows: the edge lies within column 5.
TEST(Segmentations, OfFractionsAreFeltWhereTheirFractionsSay) {
  const auto step = [](int i, int) { return i < 5 ? 0 : (i == 5 ? 60 : 200); };
  const auto edge_of = [&](const char* type) {
    const TestFolder folder;
    TestSegmentation segmentation{.type = "FRACTIONAL", .bits = 8};
    for (int n = 0; n < 24; ++n) segmentation.frames.push_back({1, 2.0 * n, step});
    segmentation.edit = [&](DcmDataset& dataset) { put(dataset, DCM_SegmentationFractionalType, type); };
    write(segmentation, folder / "seg.dcm");
    const Structure structure = structures_in(folder).structures.at(0);
    const auto field = load_distance(structure);
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
    const StructureCatalogue catalogue = structures_in(folder);
    ASSERT_EQ(catalogue.structures.size(), 2U);
    EXPECT_EQ(voxels_of(catalogue.structures[0]), 2U * 20U);
    EXPECT_EQ(voxels_of(catalogue.structures[1]), 2U * (20U - 4U));
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
  const StructureCatalogue catalogue = structures_in(folder);
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

DcmItem& new_item(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* added = nullptr;
  internal::succeed(item.findOrCreateSequenceItem(sequence, added, -2));
  return *added;
}

struct TestContour {
  std::string type;
  std::string points;
};

std::string square(double half, double z) {
  const auto n = [](double v) { return std::to_string(v); };
  return n(-half) + "\\" + n(-half) + "\\" + n(z) + "\\" + n(half) + "\\" + n(-half) + "\\" + n(z) + "\\" + n(half) +
         "\\" + n(half) + "\\" + n(z) + "\\" + n(-half) + "\\" + n(half) + "\\" + n(z);
}

StructureCatalogue contours_in(const std::vector<TestContour>& contours, const TestFolder& folder) {
  TestImage image;
  image.edit = [&](DcmDataset& dataset) {
    dataset.findAndDeleteElement(DCM_PixelData);
    put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3");
    DcmItem& roi = new_item(dataset, DCM_StructureSetROISequence);
    roi.putAndInsertString(DCM_ROINumber, "7");
    roi.putAndInsertString(DCM_ROIName, "Aorta");
    roi.putAndInsertString(DCM_ReferencedFrameOfReferenceUID, "1.2.3.9");
    DcmItem& drawn = new_item(dataset, DCM_ROIContourSequence);
    drawn.putAndInsertString(DCM_ReferencedROINumber, "7");
    drawn.putAndInsertString(DCM_ROIDisplayColor, "255\\0\\128");
    for (const TestContour& contour : contours) {
      DcmItem& item = new_item(drawn, DCM_ContourSequence);
      item.putAndInsertString(DCM_ContourGeometricType, contour.type.c_str());
      item.putAndInsertString(DCM_ContourData, contour.points.c_str());
    }
  };
  internal::write(image, folder / "rt.dcm");
  return structures_in(folder);
}

TEST(Contours, AreMeasuredByTheirPolygons) {
  const TestFolder folder;
  const auto catalogue = contours_in(
      {{"CLOSED_PLANAR", square(10, 0)}, {"CLOSED_PLANAR", square(10, 3)}, {"CLOSED_PLANAR", square(4, 3)}}, folder);
  ASSERT_EQ(catalogue.structures.size(), 1U);
  const Structure& aorta = catalogue.structures[0];
  EXPECT_EQ(aorta.kind, StructureKind::contours);
  EXPECT_EQ(aorta.number, 7);
  EXPECT_EQ(aorta.name, "Aorta");
  EXPECT_EQ(aorta.color, "#ff0080");
  EXPECT_EQ(aorta.frame_of_reference_uid, "1.2.3.9");
  EXPECT_EQ(aorta.unfit, "");
  EXPECT_NEAR(measure(aorta).volume_mm3, 3 * (400 + 400 - 64), 1e-6);
}

std::string unfit_of(const std::vector<TestContour>& contours) {
  const TestFolder folder;
  return contours_in(contours, folder).structures.at(0).unfit;
}

TEST(Contours, AreRefusedInWords) {
  EXPECT_EQ(unfit_of({}), "it is empty: it has no contour");
  EXPECT_EQ(unfit_of({{"OPEN_PLANAR", square(3, 0)}, {"POINT", "1\\2\\3"}}),
            "it has no closed contour, only 1 OPEN_PLANAR, 1 POINT");
  EXPECT_EQ(unfit_of({{"CLOSED_PLANAR", "0\\0\\0\\1\\0\\0\\0\\1"}}),
            "a contour of it has 8 numbers, not three a point");
  EXPECT_EQ(unfit_of({{"CLOSED_PLANAR", "0\\0\\0\\10\\0\\0\\10\\10\\5\\0\\10\\0"}}),
            "its contours do not lie in parallel planes: export it as SEG");
  EXPECT_EQ(unfit_of({{"CLOSED_PLANAR", "0\\0\\0\\1\\0\\0\\2\\0\\0"}}), "its contours have no area");
}

TEST(Contours, AreRefusedWholeInWords) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& dataset) { put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3"); };
  internal::write(image, folder / "rt.dcm");
  EXPECT_EQ(structures_in(folder).skipped.at(0).reason, "it names no ROI (StructureSetROISequence): export it again");
}

std::string refusal_of_contours(const std::vector<TestContour>& contours) {
  const TestFolder folder;
  const StructureCatalogue catalogue = contours_in(contours, folder);
  const Structure& structure = catalogue.structures.at(0);
  if (!structure.unfit.empty()) return structure.unfit;
  try {
    load_distance(structure);
  } catch (const DicomError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Contours, ThatAreTooLargeAreRefusedInWords) {
  EXPECT_THAT(refusal_of_contours({{"CLOSED_PLANAR", square(30000, 0)}, {"CLOSED_PLANAR", square(30000, 900)}}),
              ::testing::AllOf(HasSubstr("rt.dcm: RTSTRUCT \"Aorta\" (7) cannot be read: its contours span "),
                               HasSubstr("mm: more than can be felt")));
  std::vector<TestContour> many;
  for (int n = 0; n < 4097; ++n) many.push_back({"CLOSED_PLANAR", square(3, 0.1 * n)});
  EXPECT_EQ(refusal_of_contours(many), "its contours lie in 4097 planes; there may be 4096");
}

TEST(Contours, ThatCannotBeFeltSayWhy) {
  const TestFolder folder;
  const StructureCatalogue catalogue = contours_in({}, folder);
  try {
    measure(catalogue.structures.at(0));
    FAIL() << "was measured";
  } catch (const DicomError& error) {
    EXPECT_STREQ(error.what(), "rt.dcm: RTSTRUCT \"Aorta\" (7) cannot be felt: it is empty: it has no contour");
  }
}

TEST(Contours, ThatAreOpenAreLeftOutAndSaid) {
  const TestFolder folder;
  const auto catalogue = contours_in({{"CLOSED_PLANAR", square(3, 0)}, {"OPEN_PLANAR", square(3, 2)}}, folder);
  EXPECT_THAT(catalogue.structures.at(0).warnings,
              ::testing::ElementsAre("contours that are not closed are left out: 1 OPEN_PLANAR"));
}

TEST(Contours, AreCutShortWithoutACrash) {
  // Every length of the file: refused or read, never more.
  const TestFolder folder;
  contours_in({{"CLOSED_PLANAR", square(10, 0)}, {"CLOSED_PLANAR", square(10, 3)}}, folder);
  const auto whole = std::filesystem::file_size(folder / "rt.dcm");
  for (std::uintmax_t size = whole; size > 0; size -= std::min<std::uintmax_t>(size, 7)) {
    std::filesystem::resize_file(folder / "rt.dcm", size);
    for (const Structure& structure : structures_in(folder).structures) {
      if (structure.unfit.empty()) {
        EXPECT_NO_THROW(measure(structure));
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
