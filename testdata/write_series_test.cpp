#include "testdata/write_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <set>
#include <stdexcept>

#include "io/fresh_folder.h"
#include "testdata/scan.h"

namespace palpate::testdata {
namespace {

namespace fs = std::filesystem;

class WriteSeries : public ::testing::Test {
 protected:
  void SetUp() override {
    Grid grid;
    grid.size = {12, 10, 4};
    grid.spacing = {0.7, 0.9, 2.5};
    grid.tilt_degrees = 12;
    volume_ = scan(make_sphere(4), make_geometry(rotated(grid, {1, 1, 0}, 20)), {.noise = 20, .circle_radius = 5});
  }

  std::vector<fs::path> entries() const {
    std::vector<fs::path> found(fs::directory_iterator(root_), fs::directory_iterator{});
    return found;
  }

  const io::FreshFolder folder_ = io::temporary_folder();
  const fs::path root_ = folder_.path();
  io::Volume volume_;
};

std::string text_of(DcmItem& item, const DcmTagKey& tag) {
  OFString text;
  EXPECT_TRUE(item.findAndGetOFStringArray(tag, text).good()) << tag.toString();
  return text.c_str();
}

Vec3 triple_of(DcmItem& item, const DcmTagKey& tag, unsigned long first = 0) {
  Vec3 v(0);
  for (int n = 0; n < 3; ++n) {
    EXPECT_TRUE(item.findAndGetFloat64(tag, v[n], first + static_cast<unsigned long>(n)).good());
  }
  return v;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(WriteSeries, HoldsEveryVoxelAndItsPlace) {
  const fs::path folder = root_ / "series";
  write_series(volume_, folder, {"a sphere", "PHANTOM", "", 3});
  std::set<std::string> instances;
  for (int k = 0; k < 4; ++k) {
    DcmFileFormat file;
    ASSERT_TRUE(file.loadFile((folder / ("slice_000" + std::to_string(k + 1) + ".dcm")).c_str()).good());
    DcmDataset& item = *file.getDataset();
    EXPECT_EQ(text_of(item, DCM_SOPClassUID), UID_CTImageStorage);
    EXPECT_EQ(text_of(item, DCM_PatientName), "PHANTOM");
    EXPECT_EQ(text_of(item, DCM_SeriesNumber), "3");
    EXPECT_EQ(text_of(item, DCM_PixelSpacing), "0.9\\0.7");
    instances.insert(text_of(item, DCM_SOPInstanceUID));
    const Vec3 origin = triple_of(item, DCM_ImagePositionPatient);
    EXPECT_LT(glm::length(origin - volume_.geometry.to_patient({0, 0, k})), 1e-9);
    EXPECT_LT(glm::length(triple_of(item, DCM_ImageOrientationPatient) - volume_.geometry.direction_i), 1e-9);
    EXPECT_LT(glm::length(triple_of(item, DCM_ImageOrientationPatient, 3) - volume_.geometry.direction_j), 1e-9);
    double slope = 0;
    double intercept = 0;
    ASSERT_TRUE(item.findAndGetFloat64(DCM_RescaleSlope, slope).good());
    ASSERT_TRUE(item.findAndGetFloat64(DCM_RescaleIntercept, intercept).good());
    Sint16 padding = 0;
    ASSERT_TRUE(item.findAndGetSint16(DCM_PixelPaddingValue, padding).good());
    EXPECT_EQ(padding, volume_.padding->first);
    const Uint16* pixels = nullptr;
    unsigned long count = 0;
    ASSERT_TRUE(item.findAndGetUint16Array(DCM_PixelData, pixels, &count).good());
    ASSERT_EQ(count, 120U);
    for (int j = 0; j < 10; ++j) {
      for (int i = 0; i < 12; ++i) {
        EXPECT_EQ(slope * static_cast<Sint16>(pixels[j * 12 + i]) + intercept, volume_.value_at(i, j, k));
      }
    }
  }
  EXPECT_EQ(instances.size(), 4U);
}

TEST_F(WriteSeries, IsTheSameBytesForTheSameVolumeAndOtherUidsForAnother) {
  write_series(volume_, root_ / "a");
  write_series(volume_, root_ / "b");
  EXPECT_EQ(bytes_of(root_ / "a" / "slice_0002.dcm"), bytes_of(root_ / "b" / "slice_0002.dcm"));
  std::get<std::vector<std::int16_t>>(volume_.voxels)[60] += 1;
  write_series(volume_, root_ / "c");
  EXPECT_NE(bytes_of(root_ / "a" / "slice_0002.dcm"), bytes_of(root_ / "c" / "slice_0002.dcm"));
}

TEST_F(WriteSeries, LeavesNothingBehindOnAnError) {
  volume_.voxels = std::vector<float>(480);
  EXPECT_THROW(write_series(volume_, root_ / "floats"), std::invalid_argument);
  EXPECT_TRUE(entries().empty());
}

TEST_F(WriteSeries, RefusesAFolderInUseAndKeepsIt) {
  fs::create_directory(root_ / "used");
  std::ofstream(root_ / "used" / "notes.txt") << "mine";
  try {
    write_series(volume_, root_ / "used");
    FAIL() << "wrote into a folder in use";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find((root_ / "used").string()), std::string::npos);
  }
  EXPECT_EQ(bytes_of(root_ / "used" / "notes.txt"), "mine");
  EXPECT_EQ(entries().size(), 1U);
}

}  // namespace
}  // namespace palpate::testdata
