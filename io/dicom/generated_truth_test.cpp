/// Series written here by formula, so that every number is known: truth_test.cpp's checks on real scans, for every
/// checkout. Each voxel, its position and the series' description are compared.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <vector>

#include "io/load.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using internal::put;
using internal::TestFolder;
using internal::TestImage;
using internal::write;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string digits(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%.12g", number);
    if (!text.empty()) text += '\\';
    text += digits.data();
  }
  return text;
}
std::string digits(const Vec3& v) {
  return digits({v.x, v.y, v.z});
}

/// Oblique, not square, rows and columns not quite perpendicular, and slices that lean and are unevenly apart: rescaled
/// values of a slope and an intercept. Files lie and are numbered in no order.
struct OddStack {
  static constexpr int columns = 14, rows = 9, slices = 7;
  static constexpr double column_spacing = 0.7, row_spacing = 0.45;  // between columns, between rows
  static constexpr double slope = 2, intercept = -1000;

  Vec3 direction_i = glm::normalize(Vec3(0.9, 0.3, -0.2));
  Vec3 direction_j = glm::normalize(glm::cross(glm::normalize(Vec3(0.1, -0.2, 1)), direction_i) + 0.0005 * direction_i);

  Vec3 position(int k) const {
    const Vec3 normal = glm::normalize(glm::cross(direction_i, direction_j));
    constexpr std::array<double, slices> heights{0, 1, 2.1, 3, 4.15, 5.1, 6};
    return Vec3(-31.5, 12.25, 200) + heights[static_cast<std::size_t>(k)] * (normal + 0.2 * direction_j);
  }
  static int stored(int i, int j, int k) { return 500 * k + 30 * j + i; }

  void write_to(const fs::path& folder, E_TransferSyntax syntax, int left_out = -1) const {
    for (int k = 0; k < slices; ++k) {
      if (k == left_out) continue;
      TestImage image;
      image.columns = columns;
      image.rows = rows;
      image.syntax = syntax;
      image.value = [k](int i, int j) { return stored(i, j, k); };
      image.edit = [&, k](DcmDataset& d) {
        put(d, DCM_ImagePositionPatient, digits(position(k)));
        put(d, DCM_ImageOrientationPatient, digits(direction_i) + "\\" + digits(direction_j));
        put(d, DCM_PixelSpacing, digits({row_spacing, column_spacing}));
        put(d, DCM_SliceThickness, std::string("1"));
        put(d, DCM_RescaleSlope, digits({slope}));
        put(d, DCM_RescaleIntercept, digits({intercept}));
        put(d, DCM_RescaleType, std::string("HU"));
        put(d, DCM_SeriesDescription, std::string("odd stack"));
        put(d, DCM_InstanceNumber, std::to_string(3 * k % 7 + 1));
        if (syntax == EXS_JPEG2000LosslessOnly) {
          internal::encapsulate(d, syntax, {internal::jpeg2000(columns, rows, 16, false, image.value)}, 100);
        } else if (syntax == EXS_JPEGLSLossless) {
          internal::encapsulate(d, syntax, {internal::jpeg_ls(columns, rows, 16, 0, image.value)}, 1U << 20);
        }
      };
      write(image, folder / (internal::numbered("file", 5 * k % 7) + ".dcm"));
    }
  }
};

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& what) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << what;
}

class GeneratedTruth : public ::testing::TestWithParam<std::pair<const char*, E_TransferSyntax>> {};

TEST_P(GeneratedTruth, EveryVoxelIsInItsPlace) {
  internal::register_encoders();
  const TestFolder folder;
  const OddStack odd;
  odd.write_to(folder.path(), GetParam().second);
  const Catalogue found = internal::find_in(folder);
  EXPECT_THAT(found.skipped, IsEmpty());
  ASSERT_EQ(found.series.size(), 1U);
  const Series& series = found.series[0];
  EXPECT_TRUE(series.usable);
  EXPECT_EQ(series.description, "odd stack");
  EXPECT_EQ(series.modality, "CT");
  EXPECT_EQ(series.unit, "HU");
  EXPECT_EQ(series.uid, "1.2.3.4");
  EXPECT_EQ(series.study_uid, "1.2.3");
  EXPECT_EQ(series.files.size(), 7U);
  const Volume volume = load(series);
  const Geometry& g = volume.geometry;
  ASSERT_EQ(g.dimensions, glm::ivec3(14, 9, 7));
  EXPECT_NEAR(g.spacing_i, 0.7, 1e-9);
  EXPECT_NEAR(g.spacing_j, 0.45, 1e-9);
  EXPECT_FALSE(g.uniform);
  EXPECT_THAT(g.gaps, IsEmpty());
  expect_near(g.direction_i, odd.direction_i, 1e-9, "direction_i");
  expect_near(g.direction_j, odd.direction_j, 1e-9, "direction_j");
  expect_near(g.step, (odd.position(6) - odd.position(0)) / 6.0, 1e-9, "step");
  double sum = 0;
  for (int k = 0; k < 7; ++k) {
    expect_near(g.slice_positions[static_cast<std::size_t>(k)], odd.position(k), 1e-9, "slice position");
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 14; ++i) {
        const double value = 2.0 * OddStack::stored(i, j, k) - 1000;
        ASSERT_EQ(volume.value_at(i, j, k), value) << i << ' ' << j << ' ' << k;
        sum += value;
        const Vec3 place = odd.position(k) + (0.7 * i) * odd.direction_i + (0.45 * j) * odd.direction_j;
        expect_near(g.to_index(place), Vec3(i, j, k), 1e-6, "index");
      }
    }
  }
  const Statistics values = statistics(volume);
  EXPECT_EQ(values.count, 14U * 9U * 7U);
  EXPECT_EQ(values.minimum, -1000);
  EXPECT_EQ(values.maximum, 2.0 * OddStack::stored(13, 8, 6) - 1000);
  EXPECT_NEAR(values.mean, sum / (14 * 9 * 7), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(EveryCoding, GeneratedTruth,
                         ::testing::Values(std::pair{"implicit", EXS_LittleEndianImplicit},
                                           std::pair{"explicit", EXS_LittleEndianExplicit},
                                           std::pair{"big_endian", EXS_BigEndianExplicit},
                                           std::pair{"deflated", EXS_DeflatedLittleEndianExplicit},
                                           std::pair{"rle", EXS_RLELossless}, std::pair{"jpeg", EXS_JPEGProcess14SV1},
                                           std::pair{"jpeg_ls", EXS_JPEGLSLossless},
                                           std::pair{"jpeg_2000", EXS_JPEG2000LosslessOnly}),
                         [](const auto& which) { return std::string(which.param.first); });

TEST(GeneratedTruthWithJudgement, MissingSliceIsNamedAndKeptAsAGap) {
  const TestFolder folder;
  const OddStack odd;
  odd.write_to(folder.path(), EXS_LittleEndianExplicit, 3);
  const Series series = internal::find_in(folder).series.at(0);
  EXPECT_TRUE(series.usable);
  EXPECT_EQ(series.geometry.gaps, std::vector<int>({2}));
  EXPECT_THAT(series.warnings, ::testing::Contains(HasSubstr("1 slice is missing between slices 2 and 3")));
  const Volume volume = load(series);
  ASSERT_EQ(volume.geometry.dimensions.z, 6);
  for (int k = 0; k < 6; ++k) {
    const int written = k < 3 ? k : k + 1;
    expect_near(volume.geometry.slice_positions[static_cast<std::size_t>(k)], odd.position(written), 1e-9, "position");
    EXPECT_EQ(volume.value_at(5, 6, k), 2.0 * OddStack::stored(5, 6, written) - 1000);
  }
}

/// Siemens' private header, version 2: numbers by name.
std::vector<Uint8> csa_header(const std::map<std::string, std::vector<double>>& values) {
  std::vector<Uint8> bytes{'S', 'V', '1', '0', 4, 3, 2, 1};
  const auto add = [&](std::size_t number) {
    for (int byte = 0; byte < 4; ++byte) bytes.push_back(static_cast<Uint8>(number >> (8 * byte)));
  };
  const auto add_text = [&](const std::string& text, std::size_t size) {
    for (std::size_t n = 0; n < size; ++n) bytes.push_back(n < text.size() ? static_cast<Uint8>(text[n]) : 0);
  };
  add(values.size());
  add(77);
  for (const auto& [name, numbers] : values) {
    add_text(name, 64);
    add(numbers.size());
    add_text("FD", 4);
    add(4);
    add(numbers.size());
    add(77);
    for (const double number : numbers) {
      const std::string text = digits({number});
      const std::size_t length = text.size() + 1;
      for (const std::size_t each : {length, length, std::size_t{77}, length}) add(each);
      add_text(text, (length + 3) / 4 * 4);
    }
  }
  return bytes;
}

/// Five slices of 6 x 4 in three rows of three, on a plane that is oblique.
struct Mosaic {
  Vec3 along_i = glm::normalize(Vec3(1, 0.2, 0)), along_j = glm::normalize(Vec3(-0.2, 1, 0));
  Vec3 normal = glm::cross(along_i, along_j), corner{-40, 10, 5};
  bool says_distance = true;  // of its slices: else they are as far apart as they are thick

  static int value(int i, int j, int tile) { return 1000 * tile + 50 * j + i + 1; }
  /// `sense`: which way slices are counted, along the normal or against it. `more`: of Siemens' private header.
  void write_to(const fs::path& file, double sense, const std::map<std::string, std::vector<double>>& more = {}) const {
    TestImage image;
    image.columns = 18;
    image.rows = 12;
    image.value = [&](int i, int j) {
      const int tile = j / 4 * 3 + i / 6;
      return tile < 5 ? value(i % 6, j % 4, tile) : 0;
    };
    image.edit = [&](DcmDataset& d) {
      put(d, DCM_Modality, std::string("MR"));
      put(d, DCM_ImageType, std::string("ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC"));
      put(d, DCM_ImagePositionPatient, digits(corner));
      put(d, DCM_ImageOrientationPatient, digits(along_i) + "\\" + digits(along_j));
      put(d, DCM_PixelSpacing, digits({2.5, 2}));  // rows 2.5 mm apart, columns 2 mm
      put(d, DCM_SliceThickness, std::string("2.25"));
      if (says_distance) put(d, DCM_SpacingBetweenSlices, std::string("3"));
      std::map<std::string, std::vector<double>> values{
          {"NumberOfImagesInMosaic", {5}},
          {"SliceNormalVector", {sense * normal.x, sense * normal.y, sense * normal.z}}};
      values.insert(more.begin(), more.end());
      const auto csa = csa_header(values);
      internal::succeed(d.putAndInsertString(DcmTag(0x0029, 0x0010, EVR_LO), "SIEMENS CSA HEADER"));
      internal::succeed(d.putAndInsertUint8Array(DcmTag(0x0029, 0x1010, EVR_OB), csa.data(), csa.size()));
    };
    write(image, file);
  }
};

/// Both ways that slices can be counted, on planes across each axis of the patient and on oblique ones.
TEST(GeneratedTruthWithJudgement, MosaicIsTakenApart) {
  const std::array<std::pair<Vec3, Vec3>, 5> planes{{{{1, 0.2, 0}, {-0.2, 1, 0}},
                                                     {{0, 1, 0}, {0, 0, -1}},
                                                     {{1, 0, 0}, {0, 0, -1}},
                                                     {{0.2, 1, 0.1}, {0.1, 0.08, -1}},
                                                     {{1, 0.3, -0.2}, {0.1, 0.2, 0.8}}}};
  for (const auto& [along_i, along_j] : planes) {
    for (const double sense : {1.0, -1.0}) {
      Mosaic mosaic;
      mosaic.along_i = glm::normalize(along_i);
      mosaic.along_j = glm::normalize(along_j);
      mosaic.normal = glm::cross(mosaic.along_i, mosaic.along_j);
      const TestFolder folder;
      mosaic.write_to(folder / "mosaic.dcm", sense);
      const Catalogue found = internal::find_in(folder);
      ASSERT_EQ(found.series.size(), 1U);
      const Volume volume = load(found.series[0]);
      const Geometry& g = volume.geometry;
      ASSERT_EQ(g.dimensions, glm::ivec3(6, 4, 5));
      // The position is that of an image as large as the mosaic about the first slice's middle.
      const Vec3 first = mosaic.corner + 0.5 * (18 - 6) * 2.0 * mosaic.along_i + 0.5 * (12 - 4) * 2.5 * mosaic.along_j;
      for (int k = 0; k < 5; ++k) {
        const int tile = sense > 0 ? k : 4 - k;  // slices ascend along i x j
        expect_near(g.slice_positions[static_cast<std::size_t>(k)], first + 3.0 * sense * tile * mosaic.normal, 1e-9,
                    "position");
        for (int j = 0; j < 4; ++j) {
          for (int i = 0; i < 6; ++i) {
            ASSERT_EQ(volume.value_at(i, j, k), Mosaic::value(i, j, tile)) << i << ' ' << j << ' ' << k;
          }
        }
      }
    }
  }
}

/// Slices without a gap often say no distance.
TEST(GeneratedTruthWithJudgement, MosaicWithoutADistanceHasSlicesAsFarApartAsTheyAreThick) {
  for (const double sense : {1.0, -1.0}) {
    Mosaic mosaic;
    mosaic.says_distance = false;
    const TestFolder folder;
    mosaic.write_to(folder / "mosaic.dcm", sense);
    const Catalogue found = internal::find_in(folder);
    ASSERT_EQ(found.series.size(), 1U);
    const Volume volume = load(found.series[0]);
    ASSERT_EQ(volume.geometry.dimensions, glm::ivec3(6, 4, 5));
    const Vec3 first = mosaic.corner + 0.5 * (18 - 6) * 2.0 * mosaic.along_i + 0.5 * (12 - 4) * 2.5 * mosaic.along_j;
    for (int k = 0; k < 5; ++k) {
      const int tile = sense > 0 ? k : 4 - k;
      expect_near(volume.geometry.slice_positions[static_cast<std::size_t>(k)],
                  first + 2.25 * sense * tile * mosaic.normal, 1e-9, "position");
      EXPECT_EQ(volume.value_at(2, 1, k), Mosaic::value(2, 1, tile)) << k;
    }
  }
}

/// The private header says the diffusion weighting, too: a frame each.
TEST(GeneratedTruthWithJudgement, MosaicsOfSeveralWeightingsAreFrames) {
  const TestFolder folder;
  for (const double b : {1000.0, 0.0, 49.6}) {
    Mosaic().write_to(folder / (internal::numbered("b", static_cast<int>(b)) + ".dcm"), 1, {{"B_value", {b}}});
  }
  const Series series = internal::find_in(folder).series.at(0);
  EXPECT_THAT(series.frame_names, ::testing::ElementsAre("b = 0 s/mm2", "b = 50 s/mm2", "b = 1000 s/mm2"));
}

TEST(GeneratedTruthWithJudgement, MixedFolderGivesItsSeriesAndAReasonForTheRest) {
  const TestFolder folder;
  OddStack().write_to(folder.path(), EXS_LittleEndianExplicit);
  internal::write_stack(folder.path(), 4, [](int, TestImage& image) {
    image.series = "1.2.3.5";
    image.edit = [](DcmDataset& d) { put(d, DCM_Modality, std::string("MR")); };
  });
  TestImage odd;
  odd.series = "1.2.3.6";
  odd.edit = [](DcmDataset& d) {
    put(d, DCM_SamplesPerPixel, 3);
    put(d, DCM_PhotometricInterpretation, std::string("RGB"));
  };
  write(odd, folder / "color.dcm");
  odd.series = "1.2.3.7";
  odd.edit = [](DcmDataset& d) {
    for (const DcmTagKey& tag : {DCM_PixelData, DCM_Rows, DCM_Columns}) d.findAndDeleteElement(tag);
  };
  write(odd, folder / "contours.dcm");
  std::ofstream(folder / "empty.dcm");
  std::ofstream(folder / "README.md") << "# What lies here";
  std::ofstream(folder / "noise.dcm") << std::string(5000, '\x5A');
  // A slice's twin that ends early.
  const fs::path whole = folder / "s2.dcm", cut = folder / "cut.dcm";
  fs::copy_file(whole, cut);
  fs::resize_file(cut, fs::file_size(whole) - 10);

  const Catalogue found = internal::find_in(folder);
  std::map<std::string, glm::ivec3> usable;
  for (const Series& series : found.series) {
    if (series.usable) usable[series.uid] = load(series).geometry.dimensions;
  }
  EXPECT_EQ(usable, (std::map<std::string, glm::ivec3>{{"1.2.3.4", {14, 9, 7}}, {"1.2.3.5", {6, 4, 4}}}));
  std::map<std::string, std::string> reasons;
  for (const SkippedFile& file : found.skipped) reasons[file.path.filename().string()] = file.reason;
  EXPECT_THAT(reasons["empty.dcm"], HasSubstr("empty"));
  EXPECT_THAT(reasons["noise.dcm"], HasSubstr("not a DICOM file"));
  EXPECT_THAT(reasons["README.md"], HasSubstr("not a DICOM file"));
  EXPECT_THAT(reasons["contours.dcm"], HasSubstr("no image in it"));
  EXPECT_THAT(reasons["color.dcm"], HasSubstr("color"));
  EXPECT_THAT(reasons["cut.dcm"], ::testing::AnyOf(HasSubstr("a copy of s2.dcm"), HasSubstr("truncated")));
}

}  // namespace
}  // namespace palpate::io
