// Counts and positions that are impossible for such a file or a patient are refused without costing time or memory.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcxfer.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <string>
#include <vector>

#include "io/load.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"
#include "io/testing/voxel_files.h"

namespace palpate::io::internal {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// Of processor time, of all threads together: others may keep the machine busy.
double seconds_to_find(const TestFolder& folder, Catalogue& found) {
  const std::clock_t start = std::clock();
  found = find_in(folder);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(Bounds, FramesThatTheBytesCannotHoldCostNothing) {
  for (const char* const frames : {"100", "100000", "2147483647", "99999999999"}) {
    for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_BigEndianExplicit, EXS_RLELossless}) {
      for (const bool is_dose : {false, true}) {
        SCOPED_TRACE(std::string(frames) + (is_dose ? " of a dose, " : ", ") + DcmXfer(syntax).getXferName());
        const TestFolder folder;
        TestImage image;
        image.syntax = syntax;
        image.edit = [&](DcmDataset& d) {
          put(d, DCM_NumberOfFrames, std::string(frames));
          put(d, DCM_SpacingBetweenSlices, std::string("2"));
          if (syntax == EXS_RLELossless) encapsulate(d, syntax, {std::vector<Uint8>(100, 7)}, 1000);
          if (!is_dose) return;
          put(d, DCM_Modality, "RTDOSE");
          put(d, DCM_DoseGridScaling, std::string("1"));
        };
        write(image, folder / "a.dcm");
        Catalogue found;
        EXPECT_LT(seconds_to_find(folder, found), 1);
        ASSERT_THAT(found.skipped, SizeIs(1));
        EXPECT_THAT(std::string(found.skipped[0].reason), StartsWith("truncated: "));
      }
    }
  }
}

// Linear in the frames: with their square these would take minutes.
TEST(Bounds, ManyFramesThatAreThereAreRead) {
  constexpr int frames = 50000;
  const TestFolder folder;
  TestImage image{.columns = 2, .rows = 1};
  image.edit = [](DcmDataset& d) {
    put(d, DCM_NumberOfFrames, std::to_string(frames));
    put(d, DCM_SpacingBetweenSlices, std::string("0.1"));
    std::vector<Uint16> pixels;
    for (int n = 0; n < 2 * frames; ++n) pixels.push_back(static_cast<Uint16>(n));
    succeed(d.putAndInsertUint16Array(DCM_PixelData, pixels.data(), pixels.size()));
  };
  write(image, folder / "a.dcm");
  Catalogue found;
  EXPECT_LT(seconds_to_find(folder, found), 5);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_EQ(found.series[0].geometry.dimensions.z, frames);
}

const std::array<const char*, 7> far_places{"1e308", "-1e308", "1e300", "-1e30", "1e9", "2e5", "-100001"};

std::string place_with(const char* number, int axis) {
  std::array<std::string, 3> place{"0", "0", "0"};
  place.at(static_cast<std::size_t>(axis)) = number;
  return place[0] + "\\" + place[1] + "\\" + place[2];
}

TEST(Bounds, ImagesFartherThanAnyPatientAreSetApartAndTheOthersUsed) {
  for (const char* const far : far_places) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool is_enhanced : {false, true}) {
        SCOPED_TRACE(std::string(far) + " along axis " + std::to_string(axis) + (is_enhanced ? ", enhanced" : ""));
        const TestFolder folder;
        if (is_enhanced) {
          TestImage image;
          image.edit = [&](DcmDataset& d) {
            make_multi_frame(d, {0, 2, 4, 6, 8}, [&](std::size_t f, DcmItem& frame) {
              if (f != 4) return;
              succeed(group(frame, DCM_PlanePositionSequence)
                          .putAndInsertString(DCM_ImagePositionPatient, place_with(far, axis).c_str()));
            });
            repeat_pixels(d, 5);
          };
          write(image, folder / "a.dcm");
        } else {
          write_stack(folder.path(), 5, [&](int k, TestImage& image) {
            if (k != 4) return;
            image.edit = [&](DcmDataset& d) { put(d, DCM_ImagePositionPatient, place_with(far, axis)); };
          });
        }
        const Catalogue found = find_in(folder);
        ASSERT_THAT(found.series, SizeIs(1));
        EXPECT_EQ(found.series[0].geometry.dimensions.z, 4);
        EXPECT_EQ(load(found.series[0]).geometry.dimensions.z, 4);
        if (is_enhanced) {
          EXPECT_THAT(
              found.series[0].warnings,
              ::testing::Contains("a.dcm gives the positions of only 4 of its 5 frames: the others are left out"));
        } else {
          ASSERT_THAT(found.skipped, SizeIs(1));
          EXPECT_EQ(found.skipped[0].reason,
                    "its position is farther from the scanner than 100 m, or its pixels are too small for any patient");
        }
      }
    }
  }
}

TEST(Bounds, PixelSpacingsOfNoPatientAreSetApart) {
  for (const char* const spacing : {"1e300\\1", "1\\1e300", "30000\\1", "1e-9\\1", "1\\1e-300"}) {
    const TestFolder folder;
    write_stack(folder.path(), 4, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) { put(d, DCM_PixelSpacing, std::string(spacing)); };
    });
    const Catalogue found = find_in(folder);
    EXPECT_THAT(found.series, IsEmpty()) << spacing;
    EXPECT_THAT(found.skipped, SizeIs(4)) << spacing;
  }
}

// 90 m away is told, and nothing else: a coordinate system may begin anywhere.
TEST(Bounds, FarPlacesWithinTheBoundAreRead) {
  const TestFolder folder;
  write_stack(folder.path(), 5, [](int, TestImage& image) { image.z -= 90000; });
  EXPECT_EQ(load(only_series_in(folder)).geometry.slice_positions.front().z, -90000);
}

TEST(Bounds, OtherFormatsFartherThanAnyPatientAreRefused) {
  for (const char* const far : {"1e308", "-1e308", "1e30", "-100001"}) {
    for (int axis = 0; axis < 3; ++axis) {
      std::string place = place_with(far, axis);
      std::ranges::replace(place, '\\', ' ');
      const std::string mha = "TransformMatrix = 1 0 0 0 1 0 0 0 1\nElementSpacing = 1 1 1\nOffset = " + place + "\n";
      EXPECT_EQ(refusal_of("a.mha", meta_image(mha + "ElementDataFile = LOCAL\n") + voxels<std::int16_t>()),
                std::string(far).ends_with("308")
                    ? "its voxels are on no lattice that can be felt (no size, or axes that are sheared): resample it "
                      "with axes at right angles"
                    : "its voxels are farther from the scanner than 100 m, or too small for any patient: correct the "
                      "spacing or the unit in its header");
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal
