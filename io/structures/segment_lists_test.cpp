// Lists of segments with missing or superfluous parts: thickness of one slice, segments without a description,
// backgrounds; and masks with a file each.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/messages.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"
#include "io/testing/voxel_files.h"

namespace palpate::io {
namespace {

using internal::put;
using internal::succeed;
using internal::TestFolder;
using internal::TestSegmentation;

int twenty_pixels(int i, int j) {
  return i >= 3 && i < 8 && j >= 2 && j < 6 ? 1 : 0;
}

std::vector<Structure> segments_of(const TestSegmentation& segmentation, const TestFolder& folder) {
  internal::write(segmentation, folder / "seg.dcm");
  return find_structures(std::array{folder.path()}).structures;
}

/// Sets what the shared groups say of the slices; nothing if empty.
void set_slices(DcmDataset& dataset, const std::string& spacing, const std::string& thickness) {
  DcmItem *shared = nullptr, *measures = nullptr;
  succeed(dataset.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared, 0));
  succeed(shared->findAndGetSequenceItem(DCM_PixelMeasuresSequence, measures, 0));
  measures->findAndDeleteElement(DCM_SpacingBetweenSlices);
  measures->findAndDeleteElement(DCM_SliceThickness);
  if (!spacing.empty()) succeed(measures->putAndInsertString(DCM_SpacingBetweenSlices, spacing.c_str()));
  if (!thickness.empty()) succeed(measures->putAndInsertString(DCM_SliceThickness, thickness.c_str()));
}

TEST(SegmentLists, OneSliceIsAsThickAsItsFileSays) {
  struct Said {
    const char *spacing, *thickness;
    double mm;
  };
  double of_a_pixel = 0;
  for (const Said& said : {Said{"2", "2", 2}, {"", "2.5", 2.5}, {"3", "", 3}, {"3", "2.5", 3}, {"", "", 1}}) {
    const TestFolder folder;
    TestSegmentation segmentation{.frames = {{1, 0, twenty_pixels}}};
    segmentation.edit = [&](DcmDataset& dataset) { set_slices(dataset, said.spacing, said.thickness); };
    const auto found = segments_of(segmentation, folder);
    ASSERT_EQ(found.size(), 1U);
    const double volume = measure(found[0]).volume_mm3;
    if (of_a_pixel == 0) of_a_pixel = volume / 2 / 20;
    EXPECT_NEAR(volume, 20 * of_a_pixel * said.mm, 1e-9) << said.spacing << ' ' << said.thickness;
    EXPECT_EQ(found[0].warnings.empty(), said.mm > 1);
    if (!found[0].warnings.empty()) {
      EXPECT_EQ(
          found[0].warnings[0],
          "it has one slice, and its file does not say how thick it is: it counts as thick as a slice of the scan, "
          "and without a scan as 1 mm");
    }
  }
}

// Several slices are as far apart as they lie, whatever their thickness.
TEST(SegmentLists, ThicknessDoesNotMoveSlicesApart) {
  for (const char* const thickness : {"1", "5"}) {
    const TestFolder folder;
    TestSegmentation segmentation{.frames = {{1, 0, twenty_pixels}, {1, 2, twenty_pixels}, {1, 6, twenty_pixels}}};
    segmentation.edit = [&](DcmDataset& dataset) { set_slices(dataset, "", thickness); };
    const auto found = segments_of(segmentation, folder);
    EXPECT_EQ(measure(found.at(0)).voxels, 60U);
    EXPECT_DOUBLE_EQ(measure(found.at(0)).box_high_mm.z, 6);
    EXPECT_TRUE(found.at(0).warnings.empty());
  }
}

TEST(SegmentLists, SegmentsThatOnlyFramesNameAreListed) {
  for (const int odd : {0, 3, 9, 65535}) {
    const TestFolder folder;
    const auto found = segments_of(
        {.frames = {{odd, 0, twenty_pixels}, {1, 0, twenty_pixels}, {odd, 2, twenty_pixels}, {1, 2, twenty_pixels}}},
        folder);
    ASSERT_EQ(found.size(), 2U) << odd;
    for (const Structure& structure : found) EXPECT_EQ(measure(structure).voxels, 40U) << structure.number;
    const Structure& added = found[odd == 0 ? 0 : 1];
    EXPECT_EQ(added.number, odd);
    EXPECT_EQ(added.name, "segment " + std::to_string(odd));
    ASSERT_EQ(added.warnings.size(), 1U);
    EXPECT_EQ(added.warnings[0],
              "its file does not describe it: frames name it, and the list of segments (SegmentSequence) does not");
  }
}

// By its number, which PixelPaddingValue gives or is 0; or by its code.
TEST(SegmentLists, ABackgroundIsNoStructure) {
  const auto names_with = [](const std::function<void(DcmDataset&, DcmItem & second)>& edit) {
    const TestFolder folder;
    TestSegmentation segmentation{.type = "LABELMAP", .bits = 8, .names = {"Liver", "Rest"}};
    segmentation.frames = {{1, 0, [](int i, int) { return i % 3; }}, {1, 2, [](int i, int) { return i % 3; }}};
    segmentation.edit = [&](DcmDataset& dataset) {
      DcmItem* second = nullptr;
      succeed(dataset.findAndGetSequenceItem(DCM_SegmentSequence, second, 1));
      edit(dataset, *second);
    };
    std::vector<std::string> names;
    for (const Structure& structure : segments_of(segmentation, folder)) names.push_back(structure.name);
    return names;
  };
  const std::vector<std::string> both{"Liver", "Rest"}, liver{"Liver"};
  EXPECT_EQ(names_with([](DcmDataset&, DcmItem&) {}), both);
  EXPECT_EQ(names_with([](DcmDataset& dataset, DcmItem&) { put(dataset, DCM_PixelPaddingValue, 2); }), liver);
  EXPECT_EQ(names_with([](DcmDataset&, DcmItem& second) { succeed(second.putAndInsertUint16(DCM_SegmentNumber, 0)); }),
            liver);
  EXPECT_EQ(names_with([](DcmDataset&, DcmItem& second) {
              DcmItem* code = nullptr;
              succeed(second.findOrCreateSequenceItem(DCM_SegmentedPropertyTypeCodeSequence, code, 0));
              succeed(code->putAndInsertString(DCM_CodingSchemeDesignator, "DCM"));
              succeed(code->putAndInsertString(DCM_CodeValue, "125040"));
              succeed(code->putAndInsertString(DCM_CodeMeaning, "Background"));
            }),
            liver);
}

void write_mask(const std::filesystem::path& file, char value) {
  const std::string name = file.filename().string();
  std::string voxels(static_cast<std::size_t>(internal::nx * internal::ny * internal::nz), '\0');
  voxels[4] = voxels[5] = value;
  if (name.ends_with(".nrrd")) {
    voxels =
        "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 3 5\n"
        "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n" +
        voxels;
  } else if (name.ends_with(".mha")) {
    voxels =
        "NDims = 3\nDimSize = 4 3 5\nElementType = MET_UCHAR\nOffset = 0 0 0\nElementSpacing = 1 1 1\n"
        "ElementDataFile = LOCAL\n" +
        voxels;
  } else {
    constexpr std::int16_t of_bytes = 2;
    voxels = internal::Nifti().sform(internal::oblique()).put(70, of_bytes).bytes() + voxels;
  }
  internal::write_bytes(file, name.ends_with(".gz") ? internal::packed(voxels, 31) : voxels);
}

// As programs write a folder of them.
TEST(SegmentLists, AMaskInAFileOfItsOwnIsNamedByTheFileAlsoWhereItIsEmpty) {
  for (const char value : {'\0', '\1', '\5'}) {
    for (const std::string ending : {".nrrd", ".seg.nrrd", ".mha", ".nii", ".nii.gz"}) {
      for (const std::string organ : {"spleen", "vertebrae_L1", "kidney.left"}) {
        const TestFolder folder;
        write_mask(folder / (organ + ending), value);
        const auto found = find_structures(std::array{folder.path()}).structures;
        ASSERT_EQ(found.size(), 1U) << organ << ending;
        EXPECT_EQ(found[0].name, organ);
        EXPECT_EQ(found[0].number, value == 0 ? 1 : value);
        EXPECT_EQ(found[0].unfit, value == 0 ? say("no-voxel-inside") : Text());
        if (value != 0) {
          EXPECT_EQ(measure(found[0]).voxels, 2U);
        }
        // Of a folder it is no scan.
        EXPECT_EQ(find_series(std::array{folder.path()}).series.size(), 0U) << organ << ending;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
