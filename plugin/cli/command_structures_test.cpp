// `palpate structures` as a script meets it, against what pydicom and numpy read in the shared segmentations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::forehead;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;
using testing::phantom;

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

/// The shared liver beside a scene of these modes, which names it by the file alone.
fs::path scene_beside_liver(const std::string& segment, const std::string& modes) {
  const fs::path folder = fresh_path("liver");
  fs::create_directories(folder);
  fs::copy_file(shared / "dcmqi/liver.dcm", folder / "liver.dcm");
  std::ofstream(folder / "scene.json") << R"({"version": 1, "structures": [
    {"name": "liver", "file": "liver.dcm", "segment": )"
                                       << segment << R"(}, {"name": "unread", "file": "liver.dcm", "segment": 1}],
    "modes": [)" << modes << "]}";
  return folder / "scene.json";
}

// In the label map that the segmentation was made of (liver_seg.nrrd), row 290 of the middle slice is liver from column
// 81 to 203: the row is crossed there along x.
const std::string into_liver = " --from -180,8.2586,-127.69 --to -165,8.2586,-127.69 --scene ";
constexpr double last_outside_mm = -235.2 + 80 * 0.810547, first_inside_mm = -235.2 + 81 * 0.810547;
const std::string edge = R"({"type": "surface", "structure": "liver", "strength_n": 1})";

TEST(CommandStructures, AreFeltAtTheirEdge) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const fs::path scene = scene_beside_liver("\"Liver\"", edge);
  const Outcome outcome =
      palpate("profile --json " + (shared / "dcmqi/ct-3slice").string() + into_liver + scene.string(), false);
  ASSERT_EQ(outcome.exit, 0);
  const Json stroke = Json::parse(outcome.output);
  const Json& distances = stroke.at("distance_mm").at("liver");
  ASSERT_EQ(distances.size(), stroke.at("position_mm").size());
  EXPECT_FALSE(stroke.at("distance_mm").contains("unread"));
  EXPECT_LT(distances.front().get<double>(), -5);
  EXPECT_GT(distances.back().get<double>(), 2);
  double most = 0;
  for (std::size_t n = 0; n < distances.size(); ++n) {
    const double x = stroke.at("proxy_mm").at(n).at(0);
    const double force =
        std::hypot(stroke.at("force_n").at(n).at(0).get<double>(), stroke.at("force_n").at(n).at(1).get<double>(),
                   stroke.at("force_n").at(n).at(2).get<double>());
    if (x < last_outside_mm - 0.2) {
      EXPECT_LT(force, 1e-6) << x;
    }
    if (x < last_outside_mm) {
      EXPECT_LT(distances[n].get<double>(), 0) << x;
    }
    if (x > first_inside_mm && x < first_inside_mm + 1) {
      EXPECT_GT(distances[n].get<double>(), 0) << x;
    }
    most = std::max(most, force);
  }
  EXPECT_GT(most, 0.8);
  EXPECT_LT(most, 1 + 1e-6);
}

TEST(CommandStructures, AreLeftOutWhereNoModeReadsThem) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const Outcome outcome = palpate("plan --json " + (shared / "dcmqi/ct-3slice").string() + " --scene " +
                                  scene_beside_liver("1", edge).string());
  EXPECT_THAT(outcome.output, HasSubstr(R"(structure \"unread\")"));
  EXPECT_THAT(outcome.output, ::testing::Not(HasSubstr(R"(structure \"liver\")")));
}

TEST(CommandStructures, OfASceneAreRefusedInWords) {
  if (!fs::exists(shared)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const std::string ct = (shared / "dcmqi/ct-3slice").string();
  const fs::path unknown = scene_beside_liver("\"Spleen\"", edge);
  const Outcome outcome = palpate("profile " + ct + into_liver + unknown.string());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output, HasSubstr("structure \"liver\": liver.dcm has no \"Spleen\"; there are: 1 Liver"));
  const fs::path scene = scene_beside_liver("1", edge);
  const Outcome elsewhere = palpate("profile " + phantom().string() + forehead + "--scene " + scene.string());
  EXPECT_EQ(elsewhere.exit, 1);
  EXPECT_THAT(elsewhere.output,
              HasSubstr("liver.dcm lies in another frame of reference than the scan: choose one that was "
                        "outlined on this study"));
  fs::copy_file(fs::path(ct) / "01.dcm", scene.parent_path() / "liver.dcm", fs::copy_options::overwrite_existing);
  const Outcome none = palpate("profile " + ct + into_liver + scene.string());
  EXPECT_EQ(none.exit, 1);
  EXPECT_THAT(none.output, HasSubstr("liver.dcm holds no structures"));
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
