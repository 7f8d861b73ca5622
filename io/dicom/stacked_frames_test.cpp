// Multi-frame files that give the positions of their frames without functional groups.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcfilefo.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Frames whose values are 1000 f + 10 i + j, of 6 x 4.
void put_frames(DcmDataset& dataset, int frames) {
  std::vector<Uint16> pixels;
  for (int f = 0; f < frames; ++f) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 6; ++i) pixels.push_back(static_cast<Uint16>(1000 * f + 10 * i + j));
    }
  }
  put(dataset, DCM_NumberOfFrames, std::to_string(frames));
  succeed(dataset.putAndInsertUint16Array(DCM_PixelData, pixels.data(), static_cast<unsigned long>(pixels.size())));
}

Series only_series_of(const std::function<void(DcmDataset&)>& edit) {
  const TestFolder folder;
  TestImage image;
  image.edit = edit;
  write(image, folder / "a.dcm");
  return only_series_in(folder);
}

std::vector<double> heights_of(const Volume& volume) {
  std::vector<double> heights;
  for (const Vec3& place : volume.geometry.slice_positions) heights.push_back(place.z);
  return heights;
}

/// Loaded while its file is there.
Volume volume_of(const std::function<void(DcmDataset&)>& edit) {
  const TestFolder folder;
  TestImage image;
  image.edit = edit;
  write(image, folder / "a.dcm");
  return load(only_series_in(folder));
}

TEST(StackedFrames, LieBehindOneAnotherBySpacingBetweenSlices) {
  const Volume volume = volume_of([](DcmDataset& d) {
    put_frames(d, 3);
    put(d, DCM_ImagePositionPatient, std::string("5\\6\\7"));
    put(d, DCM_SpacingBetweenSlices, std::string("2.5"));
  });
  EXPECT_THAT(heights_of(volume), ElementsAre(7, 9.5, 12));
  EXPECT_EQ(volume.geometry.slice_positions[0].x, 5);
  EXPECT_EQ(volume.value_at(4, 3, 2), 2043);
}

// NM tomography writes a negative spacing where frames go the other way (PS3.3 C.8.4.11).
TEST(StackedFrames, ANegativeSpacingGoesAgainstTheNormal) {
  const Volume volume = volume_of([](DcmDataset& d) {
    put_frames(d, 3);
    put(d, DCM_Modality, "NM");
    d.findAndDeleteElement(DCM_ImagePositionPatient);
    d.findAndDeleteElement(DCM_ImageOrientationPatient);
    DcmItem& detector = group(d, DCM_DetectorInformationSequence);
    succeed(detector.putAndInsertString(DCM_ImagePositionPatient, "0\\0\\100"));
    succeed(detector.putAndInsertString(DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0"));
    put(d, DCM_SpacingBetweenSlices, std::string("-4"));
    succeed(d.putAndInsertTagKey(DCM_FrameIncrementPointer, DCM_SliceVector));
  });
  EXPECT_THAT(heights_of(volume), ElementsAre(92, 96, 100));
  EXPECT_EQ(volume.value_at(0, 0, 0), 2000);
  EXPECT_EQ(volume.value_at(0, 0, 2), 0);
}

TEST(StackedFrames, FramesThatFollowInTimeAreNoStack) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    put_frames(d, 3);
    put(d, DCM_SpacingBetweenSlices, std::string("2"));
    succeed(d.putAndInsertTagKey(DCM_FrameIncrementPointer, DCM_FrameTime));
  };
  write(image, folder / "a.dcm");
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.series, IsEmpty());
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].reason, "several frames without a position for each, nor a spacing between them");
}

// Whatever attribute frames follow one another by (PS3.3 C.7.6.6.1.1): those of places and none make a stack, any other
// does not, also where a spacing is said.
TEST(StackedFrames, AreAStackWhereTheirIncrementIsAPlace) {
  const std::vector<std::pair<std::optional<DcmTagKey>, bool>> pointers{
      {std::nullopt, true},           {DCM_SpacingBetweenSlices, true},
      {DCM_SliceVector, true},        {DCM_GridFrameOffsetVector, true},
      {DCM_RepetitionTime, false},    {DCM_FrameTime, false},
      {DCM_FrameTimeVector, false},   {DCM_TimeSlotVector, false},
      {DCM_EnergyWindowVector, false}};
  for (const auto& [pointer, is_stack] : pointers) {
    const TestFolder folder;
    TestImage image;
    image.edit = [&, to = pointer](DcmDataset& d) {
      put_frames(d, 3);
      put(d, DCM_SpacingBetweenSlices, std::string("2"));
      if (to) succeed(d.putAndInsertTagKey(DCM_FrameIncrementPointer, *to));
    };
    write(image, folder / "a.dcm");
    EXPECT_EQ(find_in(folder).series.size(), is_stack ? 1U : 0U) << (pointer ? pointer->toString() : "none");
  }
}

void make_dose(DcmDataset& d, const std::string& offsets, int frames) {
  put(d, DCM_SOPClassUID, UID_RTDoseStorage);
  put(d, DCM_Modality, "RTDOSE");
  put_frames(d, frames);
  put(d, DCM_ImagePositionPatient, std::string("-10\\-20\\30"));
  put(d, DCM_DoseUnits, "GY");
  put(d, DCM_DoseGridScaling, std::string("0.002"));
  put(d, DCM_GridFrameOffsetVector, offsets);
  succeed(d.putAndInsertTagKey(DCM_FrameIncrementPointer, DCM_GridFrameOffsetVector));
}

// PS3.3 C.8.8.3.2: offsets from the first plane.
TEST(Dose, IsReadInGrayWhereItsOffsetsSay) {
  const auto dose = [](DcmDataset& d) { make_dose(d, "0\\3\\7", 3); };
  const Series series = only_series_of(dose);
  EXPECT_EQ(series.unit, "Gy");
  EXPECT_TRUE(series.usable);
  EXPECT_THAT(series.warnings,
              Contains("a dose: its values are the dose planned, not density; a scene made for CT does not fit"));
  const Volume volume = volume_of(dose);
  EXPECT_EQ(volume.unit, "Gy");
  EXPECT_THAT(heights_of(volume), ElementsAre(30, 33, 37));
  EXPECT_NEAR(volume.value_at(4, 3, 2), 0.002 * 2043, 1e-6);
}

// The same section: the z coordinates of the planes, here from the head to the feet.
TEST(Dose, OffsetsMayBeThePlanesOwnCoordinates) {
  const Volume volume = volume_of([](DcmDataset& d) { make_dose(d, "30\\27\\24", 3); });
  EXPECT_THAT(heights_of(volume), ElementsAre(24, 27, 30));
  EXPECT_NEAR(volume.value_at(0, 0, 0), 0.002 * 2000, 1e-6);
}

/// The planes' own coordinates, whichever way the normal points and whichever way they are counted; and offsets, which
/// follow the normal.
TEST(Dose, LiesWhereItsPlanesSayOnRowsOfEitherSense) {
  for (const bool down : {false, true}) {  // whether the normal points to the feet
    for (const bool falling : {false, true}) {
      const Volume volume = volume_of([&](DcmDataset& d) {
        make_dose(d, falling ? "30\\27\\20" : "30\\33\\40", 3);
        put(d, DCM_ImageOrientationPatient, std::string(down ? "1\\0\\0\\0\\-1\\0" : "1\\0\\0\\0\\1\\0"));
      });
      SCOPED_TRACE(::testing::Message() << down << falling);
      const std::vector<double> planes = falling ? std::vector<double>{30, 27, 20} : std::vector<double>{30, 33, 40};
      ASSERT_EQ(volume.geometry.dimensions.z, 3);
      for (int k = 0; k < 3; ++k) {
        const auto plane = static_cast<std::size_t>(down == falling ? k : 2 - k);
        EXPECT_EQ(volume.geometry.slice_positions[static_cast<std::size_t>(k)], Vec3(-10, -20, planes[plane]));
        EXPECT_NEAR(volume.value_at(0, 0, k), 0.002 * 1000 * static_cast<double>(plane), 1e-6);
      }
    }
    const Volume volume = volume_of([&](DcmDataset& d) {
      make_dose(d, "0\\3\\7", 3);
      put(d, DCM_ImageOrientationPatient, std::string(down ? "1\\0\\0\\0\\-1\\0" : "1\\0\\0\\0\\1\\0"));
    });
    const double sense = down ? -1 : 1;
    EXPECT_THAT(heights_of(volume), ElementsAre(30, 30 + sense * 3, 30 + sense * 7));
  }
}

TEST(Dose, ScalingThatIsNotAboveZeroIsRefused) {
  for (const std::string scaling : {"0", "-0.002"}) {
    const TestFolder folder;
    TestImage image;
    image.edit = [&](DcmDataset& d) {
      make_dose(d, "0\\3\\7", 3);
      put(d, DCM_DoseGridScaling, scaling);
    };
    write(image, folder / "a.dcm");
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.skipped, SizeIs(1)) << scaling;
    EXPECT_EQ(found.skipped[0].reason, "a dose without DoseGridScaling, which says what its values are");
  }
}

// One plane needs neither offsets nor a spacing.
TEST(Dose, OfOnePlaneLiesWhereItSays) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    make_dose(d, "0", 1);
    d.findAndDeleteElement(DCM_GridFrameOffsetVector);
    d.findAndDeleteElement(DCM_FrameIncrementPointer);
  };
  write(image, folder / "a.dcm");
  const Series series = only_series_in(folder);
  EXPECT_FALSE(series.usable) << "one slice";
  const Volume volume = load(series);
  EXPECT_EQ(volume.geometry.slice_positions.at(0), Vec3(-10, -20, 30));
  EXPECT_NEAR(volume.value_at(4, 3, 0), 0.002 * 43, 1e-6);
}

TEST(Dose, WithoutItsScalingIsRefused) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    make_dose(d, "0\\3\\7", 3);
    d.findAndDeleteElement(DCM_DoseGridScaling);
  };
  write(image, folder / "a.dcm");
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].reason, "a dose without DoseGridScaling, which says what its values are");
  EXPECT_EQ(found.skipped[0].kind, "dose distribution");
}

/// A grid as UIH's notes have it: 5 slices in 3 columns and 2 rows of tiles of 4 x 3; the value in a tile is
/// 100 k + 10 i + j.
TestImage grid() {
  constexpr int slices = 5, across = 3, columns = 4, rows = 3;
  TestImage image;
  image.columns = across * columns;
  image.rows = 2 * rows;
  image.value = [](int i, int j) {
    const int tile = j / rows * across + i / columns;
    return tile < slices ? 100 * tile + 10 * (i % columns) + j % rows : 9999;
  };
  image.edit = [](DcmDataset& d) {
    put(d, DCM_Modality, "MR");
    put(d, DCM_ImageType, "ORIGINAL\\PRIMARY\\M\\VFRAME");
    put(d, DCM_ImageOrientationPatient, std::string("0\\1\\0\\0\\0\\-1"));
    succeed(d.putAndInsertString(DcmTag(0x0065, 0x0010, EVR_LO), "Image Private Header"));
    succeed(d.putAndInsertFloat64(DcmTag(0x0065, 0x1009, EVR_FD), 1000));
    succeed(d.putAndInsertString(DcmTag(0x0065, 0x1050, EVR_DS), "5"));
    auto* sequence = new DcmSequenceOfItems(DcmTag(0x0065, 0x1051, EVR_SQ));  // the dataset's
    for (int k = 0; k < slices; ++k) {
      auto* item = new DcmItem();
      const std::string place = std::to_string(-3 * k) + "\\11\\12";
      succeed(item->putAndInsertString(DCM_ImagePositionPatient, place.c_str()));
      succeed(sequence->append(item));
    }
    succeed(d.insert(sequence));
  };
  return image;
}

// Also without VRs, where the dictionary does not know the sequence.
TEST(Grid, OfUihIsTakenApart) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit}) {
    const TestFolder folder;
    TestImage image = grid();
    image.syntax = syntax;
    write(image, folder / "a.dcm");
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.series, SizeIs(1)) << (found.skipped.empty() ? Text() : found.skipped.front().reason);
    const Volume volume = load(found.series[0]);
    EXPECT_EQ(volume.geometry.dimensions, glm::ivec3(4, 3, 5));
    // The normal of these directions is -x: slices ascend from x = 0 to -12.
    for (int k = 0; k < 5; ++k) {
      EXPECT_EQ(volume.geometry.slice_positions[static_cast<std::size_t>(k)], Vec3(-3 * k, 11, 12));
      EXPECT_EQ(volume.value_at(3, 2, k), 100 * k + 32);
    }
  }
}

TEST(Grid, WithoutItsSequenceOrItsCountIsRefused) {
  for (const Uint16 element : {Uint16{0x1051}, Uint16{0x1050}}) {
    const TestFolder folder;
    TestImage image = grid();
    const auto whole = image.edit;
    image.edit = [&](DcmDataset& d) {
      whole(d);
      d.findAndDeleteElement(DcmTagKey(0x0065, element));
    };
    write(image, folder / "a.dcm");
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.skipped, SizeIs(1)) << element;
    EXPECT_EQ(found.skipped[0].reason, "UIH grid without the private sequence that says where its slices lie");
  }
}

}  // namespace
}  // namespace palpate::io::internal
