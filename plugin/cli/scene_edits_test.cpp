// A scene with an edited structure: the felt outline is the one that `palpate correct` writes, and a recording replays
// it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/load.h"
#include "io/structures/label_image.h"
#include "io/testing/outlined_scan.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/open_scan.h"
#include "plugin/recording/recording.h"
#include "plugin/session/tick_record.h"
#include "plugin/structures/scene_structures.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;
using testing::phantom;

/// The phantom's core as a label map, and a scene that feels its edge.
struct EditedScene {
  fs::path folder = testing::fresh_path("edited_scene");
  io::Series series = io::find_series(std::array{phantom()}).series.at(0);

  EditedScene() {
    fs::create_directories(folder);
    const auto core = [](const io::Vec3& at) { return 15 - glm::length(at); };
    write_label_map(sample_labels({.name = "core"}, series.geometry, core), folder / "core.nii.gz",
                    io::testing::by_test);
  }
  Json scene(const Json& edits) const {
    return {{"version", 1},
            {"structures", {{{"name", "core"}, {"file", "core.nii.gz"}, {"segment", 1}, {"edits", edits}}}},
            {"modes", {{{"type", "surface"}, {"structure", "core"}, {"strength_n", 1.5}}}}};
  }
  std::string write(const std::string& name, const Json& json) const {
    std::ofstream(folder / name) << json;
    return (folder / name).string();
  }
};

/// A hill of 4 mm on the side that the probe comes from, a hole beside it, and the scan's own edge elsewhere.
Json all_edits() {
  Json hill = Json::array();
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const double aside = 4.0 * (i * i + j * j), hill_mm = std::max(0.0, 4 * (1 - aside / 64));
      const double radius = 15 + hill_mm;
      if (aside < 36) hill.push_back({2 * i, -std::sqrt(radius * radius - aside), 2 * j});
    }
  }
  return {{{"type", "trace"}, {"points_mm", hill}, {"reach_mm", 10}},
          {{"type", "remove"}, {"path_mm", {{0, 15, 0}, {0, 12, 3}}}, {"radius_mm", 3}},
          {{"type", "scan_edge"}, {"center_mm", {15, 0, 0}}, {"radius_mm", 6}, {"most_mm", 2}}};
}

modes::Plan plan_of_the_structure() {
  modes::Plan plan;
  plan.structures = {0};
  return plan;
}

TEST(SceneEdits, WhatIsFeltIsWhatCorrectWrites) {
  const EditedScene edited;
  const modes::Scene scene = modes::load_scene(edited.write("scene.json", edited.scene(all_edits())));
  const io::Volume scan = open_scan(edited.series, 0);
  const auto felt = load_structures(scene, plan_of_the_structure(), scan, {}).front();
  const std::string edits = edited.write("edits.json", {{"version", 1}, {"edits", all_edits()}});
  const std::string written = (edited.folder / "mended.nii.gz").string();
  const Outcome outcome = palpate("correct " + phantom().string() + " --structure " +
                                  (edited.folder / "core.nii.gz").string() + " --edits " + edits + " -o " + written);
  ASSERT_EQ(outcome.exit, 0) << outcome.output;
  const auto mended = io::load(io::find_series(std::array{fs::path(written)}).series.at(0));
  const glm::ivec3 size = scan.geometry.dimensions;
  ASSERT_EQ(mended.geometry.dimensions, size);
  std::size_t inside = 0, other = 0, of_the_hill = 0;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const io::Vec3 at = scan.geometry.to_patient({i, j, k});
        const glm::ivec3 voxel(glm::round(mended.geometry.to_index(at)));
        const bool is_written = mended.value_at(voxel.x, voxel.y, voxel.z) > 0.5;
        const double mm = felt.distance->sample(at).mm;
        inside += is_written ? 1 : 0;
        of_the_hill += is_written && at.y < -16 ? 1 : 0;
        if (is_written == (mm > 0)) continue;
        ++other;
        EXPECT_LT(std::abs(mm), 0.02) << "the two keep their distances to different reaches";
      }
    }
  }
  EXPECT_GT(inside, 12000U);
  EXPECT_GT(of_the_hill, 100U);
  EXPECT_LT(other, 5U);
}

TEST(SceneEdits, UndoAndRedoGiveTheBitsAndOnlyNewEditsAreApplied) {
  const EditedScene edited;
  modes::Scene scene = modes::load_scene(edited.write("scene.json", edited.scene(all_edits())));
  const io::Volume scan = open_scan(edited.series, 0);
  const modes::Plan plan = plan_of_the_structure();
  const std::vector<io::Edit> all = scene.structures[0].edits;
  std::vector<LoadedStructure> now;
  std::vector<std::shared_ptr<const io::DistanceField>> after;
  for (std::size_t count = 0; count <= all.size(); ++count) {
    scene.structures[0].edits.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    now = load_structures(scene, plan, scan, now);
    after.push_back(now.front().distance);
  }
  for (std::size_t count = all.size(); count-- > 0;) {
    scene.structures[0].edits.resize(count);
    now = load_structures(scene, plan, scan, now);
    EXPECT_EQ(now.front().distance, after[count]) << "an undone edit leaves the field that was before it";
  }
  scene.structures[0].edits = all;
  now = load_structures(scene, plan, scan, now);
  const auto at_once = load_structures(scene, plan, scan, {});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-24, 24);
  for (int n = 0; n < 20000; ++n) {
    const io::Vec3 at(any(random), any(random), any(random));
    const io::Distance redone = now.front().distance->sample(at), fresh = at_once.front().distance->sample(at);
    const io::Distance first = after.back()->sample(at);
    ASSERT_EQ(std::memcmp(&redone, &first, sizeof redone), 0);
    ASSERT_EQ(std::memcmp(&redone, &fresh, sizeof redone), 0);
  }
}

/// Where the hand is when it is first pushed, in the device's frame.
glm::dvec3 first_push_m(const fs::path& recording) {
  for (const TickRecord& tick : read_recording(recording.string()).ticks) {
    if (glm::length(vector_of(tick.force_n)) > 0.1) return vector_of(tick.probe_m);
  }
  return glm::dvec3(NAN);
}

TEST(SceneEdits, TheEditedEdgeIsFeltAndARecordingRepeatsItToTheBit) {
  const EditedScene edited;
  const auto felt = [&](const Json& edits, const std::string& name) {
    const std::string scene = edited.write(name + ".json", edited.scene(edits));
    const fs::path out = edited.folder / name;
    const Outcome outcome =
        palpate("probe " + phantom().string() + testing::forehead + "--scene " + scene + " -o " + out.string());
    EXPECT_EQ(outcome.exit, 0) << outcome.output;
    const std::string recording = (out / "recording.h5").string();
    const Outcome again =
        palpate("replay " + recording + " " + phantom().string() + " --structures " + edited.folder.string());
    EXPECT_EQ(again.exit, 0) << again.output;
    EXPECT_THAT(again.output, HasSubstr("the same to the last bit"));
    return first_push_m(recording);
  };
  const glm::dvec3 as_outlined = felt(Json::array(), "as_outlined"), on_the_hill = felt(all_edits(), "edited");
  // `probe` presses 6 mm beside the hill's top, along y: there the hill is 1.75 mm high.
  const double outlined_mm = std::sqrt(15.0 * 15 - 36), edited_mm = std::sqrt(16.75 * 16.75 - 36);
  EXPECT_NEAR(1e3 * glm::distance(as_outlined, on_the_hill), edited_mm - outlined_mm, 0.25);
}

TEST(SceneEdits, AnEditThatCannotBeDoneIsRefusedByTheStructuresName) {
  const EditedScene edited;
  const Json far{{"type", "trace"}, {"points_mm", {{28, 0, 0}}}, {"reach_mm", 4}};
  const std::string scene = edited.write("far.json", edited.scene(Json::array({far})));
  const Outcome outcome = palpate("probe " + phantom().string() + testing::forehead + "--scene " + scene + " -o " +
                                  (edited.folder / "none").string());
  EXPECT_NE(outcome.exit, 0);
  EXPECT_THAT(outcome.output, HasSubstr("structure \"core\": edit 1: trace: its point 1 lies "));
  EXPECT_FALSE(fs::exists(edited.folder / "none"));
}

/// The phantom's core again, as circles on planes.
Json contours_of_the_core() {
  Json loops = Json::array();
  for (double z = -14.5; z < 15; z += 1) {
    Json loop = Json::array();
    const double radius = std::sqrt(225 - z * z);
    for (int n = 0; n < 90; ++n) {
      loop.push_back({radius * std::cos(0.0698132 * n), radius * std::sin(0.0698132 * n), z});
    }
    loops.push_back(loop);
  }
  return {{"type", "contours"}, {"loops_mm", loops}};
}

/// Each is felt, so that all are kept to the same reach.
Json scene_of_drawn(const Json& structures) {
  Json modes = Json::array();
  for (const Json& one : structures) {
    modes.push_back({{"type", "surface"}, {"structure", one["name"]}, {"strength_n", 1.5}});
  }
  return {{"version", 1}, {"structures", structures}, {"modes", modes}};
}

TEST(SceneEdits, AStructureWithoutAFileIsMadeOfItsContoursFeltAndRepeated) {
  const EditedScene edited;
  const auto press = [&](const Json& scene, const std::string& name) {
    const fs::path out = edited.folder / name;
    const Outcome outcome = palpate("probe " + phantom().string() + testing::forehead + "--scene " +
                                    edited.write(name + ".json", scene) + " -o " + out.string());
    EXPECT_EQ(outcome.exit, 0) << outcome.output;
    return (out / "recording.h5").string();
  };
  const Json remove{{"type", "remove"}, {"path_mm", {{15, 0, 0}}}, {"radius_mm", 3}};
  const Json drawn{{"name", "drawn"}, {"edits", Json::array({contours_of_the_core(), remove})}};
  const std::string recording = press(scene_of_drawn(Json::array({drawn})), "drawn");
  // Nothing but the scan is needed to repeat it: the recording holds the contours.
  const Outcome again = palpate("replay " + recording + " " + phantom().string());
  EXPECT_EQ(again.exit, 0) << again.output;
  EXPECT_THAT(again.output, HasSubstr("the same to the last bit"));
  const std::string of_file = press(edited.scene(Json::array()), "of_file");
  EXPECT_LT(1e3 * glm::distance(first_push_m(recording), first_push_m(of_file)), 0.3);
}

TEST(SceneEdits, DrawnStructuresAreKeptApartAndUndone) {
  const EditedScene edited;
  Json smaller = contours_of_the_core();
  for (Json& loop : smaller["loops_mm"]) {
    for (Json& point : loop) point[0] = 0.5 * point[0].get<double>();
  }
  const Json remove{{"type", "remove"}, {"path_mm", {{0, 15, 0}}}, {"radius_mm", 3}};
  const Json two = Json::array({{{"name", "one"}, {"edits", Json::array({contours_of_the_core(), remove})}},
                                {{"name", "two"}, {"edits", Json::array({smaller})}}});
  modes::Scene scene = modes::load_scene(edited.write("two.json", scene_of_drawn(two)));
  EXPECT_EQ(scene.structures[0].file, "");
  const io::Volume scan = open_scan(edited.series, 0);
  modes::Plan plan;
  plan.structures = {0, 1};
  const auto first = load_structures(scene, plan, scan, {});
  EXPECT_NEAR(first[0].distance->sample({14, 0, 0}).mm, 1, 0.1);
  EXPECT_NEAR(first[0].distance->sample({0, 12, 0}).mm, 0, 0.1);
  EXPECT_NEAR(first[1].distance->sample({7.5, 0, 0}).mm, 0, 0.15);
  scene.structures[0].edits.pop_back();
  const auto undone = load_structures(scene, plan, scan, first);
  EXPECT_EQ(undone[0].distance, first[0].before_edits.at(1));
  EXPECT_EQ(undone[1].distance, first[1].distance);
  // Drawn again, they are found while they are held.
  EXPECT_EQ(load_structures(scene, plan, scan, {})[0].distance, undone[0].distance);
  // Another first edit makes another one.
  std::swap(scene.structures[0].edits, scene.structures[1].edits);
  const auto swapped = load_structures(scene, plan, scan, undone);
  EXPECT_EQ(swapped[0].distance, undone[1].distance);
  EXPECT_EQ(swapped[1].distance, undone[0].distance);
}

TEST(SceneEdits, ContoursThatMakeNothingAreRefusedByTheStructuresName) {
  const EditedScene edited;
  const Json flat{{"type", "contours"}, {"loops_mm", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}}};
  const Json drawn{{"name", "drawn"}, {"edits", Json::array({flat})}};
  const Outcome outcome = palpate("probe " + phantom().string() + testing::forehead + "--scene " +
                                  edited.write("flat.json", scene_of_drawn(Json::array({drawn}))) + " -o " +
                                  (edited.folder / "none").string());
  EXPECT_NE(outcome.exit, 0);
  EXPECT_THAT(outcome.output, HasSubstr("structure \"drawn\": edit 1: contours: its contours have no area"));
}

}  // namespace
}  // namespace palpate::plugin
