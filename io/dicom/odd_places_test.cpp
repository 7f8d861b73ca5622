// Legal or common habits of scanners, archives and anonymizers that a reader can get wrong silently: the positions of
// images.
#include <dcmtk/config/osconfig.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(OddPlaces, PositionsThatJitterAreOneStackOfFrames) {
  const TestFolder folder;
  for (int n = 0; n < 12; ++n) {
    TestImage image;
    image.z = 2.0 * (n % 6) + 1e-3 * ((n * 7) % 5 - 2);
    image.edit = [n](DcmDataset& d) {
      put(d, DCM_TemporalPositionIdentifier, std::to_string(1 + n / 6));
      put(d, DCM_SpacingBetweenSlices, "5");  // which is not so
      put(d, DCM_SliceThickness, "9");
    };
    write(image, folder / std::to_string(n));
  }
  const Series series = find_in(folder).series.at(0);
  EXPECT_EQ(series.frames_per_position, 2);
  EXPECT_TRUE(series.geometry.uniform);
  EXPECT_THAT(series.geometry.gaps, IsEmpty());
  EXPECT_NEAR(series.geometry.slice_spacing(), 2, 1e-3);
}

TEST(OddPlaces, SlicesDisplacedSidewaysAreUsedWhereTheyAre) {
  const TestFolder folder;
  write_stack(folder.path(), 6, [](int k, TestImage& image) {
    image.edit = [k](DcmDataset& d) {
      put(d, DCM_Modality, "MR");
      put(d, DCM_ImagePositionPatient, std::to_string(k % 2) + "\\0\\" + std::to_string(2 * k));
    };
  });
  const Series series = find_in(folder).series.at(0);
  EXPECT_THAT(series.warnings, ElementsAre(HasSubstr("displaced sideways")));
  const Vec3 at = load(series).geometry.to_index({1 + 3 * 0.75, 2 * 0.5, 6});
  EXPECT_NEAR(at.x, 3, 1e-9);
  EXPECT_NEAR(at.z, 3, 1e-9);
}

TEST(OddPlaces, LocalizerOfThreeOrientationsIsNoVolume) {
  const TestFolder folder;
  const std::array orientations{"1\\0\\0\\0\\1\\0", "1\\0\\0\\0\\0\\-1", "0\\1\\0\\0\\0\\-1"};
  for (std::size_t o = 0; o < orientations.size(); ++o) {
    TestImage image;
    image.edit = [&](DcmDataset& d) {
      put(d, DCM_Modality, "MR");
      put(d, DCM_ImageOrientationPatient, orientations[o]);
    };
    write(image, folder / std::to_string(o));
  }
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_FALSE(found.series[0].usable);
  EXPECT_THAT(found.series[0].files, SizeIs(3));
}

TEST(OddPlaces, ReformatsOfAnotherPixelSpacingAreAVolumeOfTheirOwn) {
  const TestFolder folder;
  write_stack(folder.path(), 4);
  fs::create_directory(folder / "fine");
  write_stack(folder / "fine", 3, [](int, TestImage& image) {
    image.edit = [](DcmDataset& d) { put(d, DCM_PixelSpacing, "0.25\\0.25"); };
  });
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(2));
  EXPECT_EQ(found.series[0].geometry.dimensions.z, 3);  // in the order of their files
  EXPECT_EQ(found.series[1].geometry.dimensions.z, 4);
}

TEST(OddPlaces, WideGapsAreToldOf) {
  for (const double step : {10.0, 40.0}) {
    const TestFolder folder;
    write_stack(folder.path(), 5, [step](int k, TestImage& image) { image.z = step * k; });
    const std::string told =
        "slices are 40.00 mm apart and pixels 0.50 mm: edges are felt within a slice, and hardly across slices";
    const Series series = find_in(folder).series.at(0);
    EXPECT_TRUE(series.usable);
    EXPECT_EQ(std::ranges::count(series.warnings, told), step > 20 ? 1 : 0);
  }
}

}  // namespace
}  // namespace palpate::io::internal
