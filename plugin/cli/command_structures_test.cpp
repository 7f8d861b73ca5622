// `palpate structures` as a script meets it, against what pydicom and numpy read in the shared segmentations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;

const fs::path shared = fs::path(PALPATE_SHARED_DATA) / "structures";

TEST(CommandStructures, SaysWhatTheTruthSays) {
  std::ifstream file(shared / "truth.json");
  if (!file) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const Json truth = Json::parse(file);
  for (const std::string name : {"dcmqi/liver.dcm", "dcmqi/24x38x3/seg/label.seg"}) {
    SCOPED_TRACE(name);
    const Outcome outcome = palpate("structures --json " + (shared / name).string(), false);
    ASSERT_EQ(outcome.exit, 0);
    const Json found = Json::parse(outcome.output).at("structures").at(0);
    const Json& wanted = truth.at(name).at("segments").at("1");
    EXPECT_EQ(found.at("kind"), "SEG");
    EXPECT_EQ(found.at("number"), 1);
    EXPECT_EQ(found.at("name"), wanted.at("name"));
    EXPECT_EQ(found.at("voxels"), wanted.at("voxels"));
    EXPECT_NEAR(found.at("volume_mm3").get<double>(), wanted.at("mm3").get<double>(), 0.01);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(found.at("centroid_mm").at(axis).get<double>(), wanted.at("centroid").at(axis).get<double>(), 1e-3);
      EXPECT_NEAR(found.at("box_mm").at(0).at(axis).get<double>(), wanted.at("low").at(axis).get<double>(), 1e-3);
      EXPECT_NEAR(found.at("box_mm").at(1).at(axis).get<double>(), wanted.at("high").at(axis).get<double>(), 1e-3);
    }
  }
}

TEST(CommandStructures, SaysWhereThereAreNone) {
  const fs::path folder = fresh_path("no_structures");
  fs::create_directories(folder);
  const Outcome outcome = palpate("structures " + folder.string(), true);
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output,
              HasSubstr("no structures in what was given: no DICOM SEG, RTSTRUCT or label map that can be read"));
}

}  // namespace
}  // namespace palpate::plugin
