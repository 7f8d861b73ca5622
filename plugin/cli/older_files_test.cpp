// Files of older versions can still be read: the recording and the scene in testdata/0.1.0, made by version 0.1.0.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "modes/scene/scene_json.h"
#include "plugin/recording/recording.h"
#include "plugin/report/summary.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/testing/command_rig.h"
#include "solver/analytical.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using ::testing::HasSubstr;

const std::filesystem::path written_by_010 = std::filesystem::path(PALPATE_SOURCES) / "testdata/0.1.0";
const std::string scene_file = (written_by_010 / "scene.json").string();
const std::string recording_file = (written_by_010 / "recording.h5").string();

io::Volume felt_then() {
  testdata::Acquisition acquisition;
  acquisition.slice_thickness = 1;
  return testdata::scan(testdata::make_sphere(8), testdata::make_geometry({.size = glm::ivec3(24)}), acquisition);
}

/// The series that was felt; its README has the commands.
const std::string& series_felt_then() {
  static const std::string folder = [] {
    const auto path = fresh_path("felt by 0.1.0");
    testdata::write_series(felt_then(), path);
    return path.string();
  }();
  return folder;
}

/// Every tick is there and solved, and no hand would tell it from then: this version feels sharp edges otherwise, by
/// less than 0.02 N here, which the command says with its exit.
TEST(OlderFiles, ARecordingIsReplayedAndWhatIsFeltOtherwiseNowIsSaid) {
  const std::string replay = "replay " + recording_file + " '" + series_felt_then() + "'";
  const Outcome numbers = palpate(replay + " --json", false);
  const auto json = nlohmann::json::parse(numbers.output);
  EXPECT_EQ(json["frames"], 800);
  EXPECT_LT(json["largest_force_n"], 0.02);
  EXPECT_LT(json["largest_proxy_m"], 0.05e-3);
  const Outcome words = palpate(replay);
  EXPECT_EQ(words.exit, 1);
  EXPECT_THAT(words.output, HasSubstr("made by another version?"));
}

/// Against what 0.1.0 wrote itself, in its summary.txt.
TEST(OlderFiles, ARecordingHasTheSummaryThatItHadThen) {
  const Recording recording = read_recording(recording_file);
  EXPECT_EQ(recording.header.palpate_version, "0.1.0");
  EXPECT_TRUE(recording.complete);
  EXPECT_TRUE(recording.gaps.empty());
  ASSERT_EQ(recording.scenes.size(), 1U);
  EXPECT_EQ(recording.scenes[0].scene, recording.header.scene);
  EXPECT_FALSE(recording.scenes[0].frame) << "0.1.0 did not tell";
  EXPECT_TRUE(recording.known_to_mm.empty());
  ASSERT_EQ(recording.styluses.size(), 1U);
  EXPECT_EQ(recording.styluses[0].name, "simulated");

  const modes::Scene scene = modes::scene_from_json(recording.scenes[0].scene, "0.1.0's scene");
  const auto plan = plan_for(scene, felt_then(), recording.scenes[0].half_extent_m);
  const Summary summary = summarize(recording, *plan);
  EXPECT_EQ(summary.ticks, 800U);
  EXPECT_EQ(summary.solver_ticks[solver::analytical_solver.number], 800U);
  EXPECT_NEAR(summary.duration_s, 4.0, 0.05);
  ASSERT_EQ(summary.holds.size(), 1U);
  const HeldStretch& held = summary.holds.front();
  EXPECT_EQ(display_name(scene, held.mode), "air to soft tissue");
  EXPECT_NEAR(held.begin_s, 1.675, 0.0006);
  EXPECT_NEAR(held.end_s, 3.605, 0.0006);
  EXPECT_EQ(patient_coordinates(held.contact_mm), "R 0.0 A 5.6 H 5.8 mm");
  EXPECT_NEAR(held.value, -553, 0.5);
  EXPECT_NEAR(held.peak_n, 0.31, 0.005);
  EXPECT_NEAR(summary.peak_sent_n, 0.31, 0.005);
}

/// 0.1.0's `palpate profile` with this scene met the boundary 3.95 mm after -12 mm, with up to 1.10 N.
TEST(OlderFiles, ASceneIsFeltAsItWasThen) {
  const Outcome profile = palpate("profile '" + series_felt_then() + "' --from 0,-12,0 --to 0,0,0 --scene " +
                                  scene_file + " -o " + fresh_path("then.png").string());
  EXPECT_EQ(profile.exit, 0) << profile.output;
  EXPECT_THAT(profile.output, HasSubstr("air to soft tissue met at depth 3.95 mm"));
  EXPECT_THAT(profile.output, HasSubstr("up to 1.10 N"));
}

/// Nothing that it said is lost or changed; this version may say more.
TEST(OlderFiles, ASceneKeepsAllThatItSaid) {
  std::ifstream file(scene_file);
  const auto then = nlohmann::json::parse(file);
  const auto now = nlohmann::json::parse(modes::to_json(modes::load_scene(scene_file)));
  for (const auto& change : nlohmann::json::diff(then, now)) EXPECT_EQ(change["op"], "add") << change;
}

}  // namespace
}  // namespace palpate::plugin
