// A session with a structure that a registration put on the scan is repeated by the recording alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "plugin/app/recording_header.h"
#include "plugin/app/run_session.h"
#include "plugin/recording/recorder.h"
#include "plugin/recording/replay.h"
#include "plugin/report/summary.h"
#include "plugin/session/scan_hash.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using io::internal::TestFolder;
using ::testing::HasSubstr;

/// A turn by 20 degrees about z, cos and sin as the file has them, and a shift.
constexpr double cosine = 0.93969262078591, sine = 0.34202014332567;
constexpr const char* turned =
    "0.93969262078591\\-0.34202014332567\\0\\100.3\\0.34202014332567\\0.93969262078591\\0\\-0.7\\0\\0\\1\\0."
    "1\\0\\0\\0\\1";

modes::Scene scene_in(const fs::path& study) {
  modes::Scene scene = testing::scene_of(study / "rt.dcm");
  scene.workspace.center_mm = glm::dvec3(100, -14, 9);  // before the cube's face
  scene.workspace.fit = false;
  return scene;
}

/// Into the cube and out of it. `meanwhile`: between the reading of the structure and the recording.
Recording record(
    const fs::path& study, const fs::path& file, const std::function<void()>& meanwhile = [] {}) {
  const auto volume = testing::registered_scan();
  const modes::Scene scene = scene_in(study);
  const auto stylus = std::make_shared<device::SimulatedStylus>();
  const device::Specification specification = stylus->specification();
  const PreparedScene felt = prepare(scene, volume, specification.workspace_half_extent);
  meanwhile();
  // The stylus' z points out of the screen: to the patient's front, -y.
  const std::vector<device::Waypoint> way{{.time = 0, .position = {0, 0, 0.005}},
                                          {.time = 0.6, .position = {0, 0, 0.005}},
                                          {.time = 1.6, .position = {0, 0, -0.010}},
                                          {.time = 2.2, .position = {0.003, 0, 0.005}}};
  stylus->follow(way);
  TickRing ring;
  const std::string hash = hash_of(*volume);
  Recorder recorder(ring, file, header_for(scene, specification, hash));
  recorder.note(record_of(scene, felt, specification, hash));
  recorder.note(StylusRecord{.epoch = 0,
                             .name = specification.name,
                             .force_axes = specification.force_axes,
                             .maximum_force_n = specification.maximum_force});
  Session session(snapshot_of(scene, felt, specification), stylus, &ring);
  for (int n = 0; n < 2200; ++n) {
    session.tick();
    if (n % 256 == 0) recorder.wait_for_room();
  }
  EXPECT_FALSE(recorder.finish().stopped);
  return read_recording(file);
}

Replay repeat(const Recording& recording, const fs::path& study) {
  StructureFiles files({study});
  return replay(recording,
                [&](const SceneRecord& scene) { return snapshot_of(scene, testing::registered_scan(), files); });
}

TEST(RegisteredReplay, IsTheSameWhereTheRegistrationIsNot) {
  const TestFolder folder;
  const fs::path study = folder / "study", elsewhere = folder / "elsewhere";
  testing::write_contours(study / "rt.dcm", "1.2", "7", "Doe^Jane");
  testing::write_registration(study / "reg.dcm", turned);
  const Recording recording = record(study, folder / "felt.h5");
  double strongest_n = 0;
  for (const TickRecord& tick : recording.ticks)
    strongest_n = std::max(strongest_n, glm::length(vector_of(tick.force_n)));
  EXPECT_GT(strongest_n, 0.5);

  fs::create_directories(elsewhere);
  fs::copy_file(study / "rt.dcm", elsewhere / "other_name.dcm");
  const Replay alone = repeat(recording, elsewhere);
  EXPECT_EQ(alone.ticks, 2200U);
  EXPECT_EQ(alone.different, 0U);
  testing::write_registration(elsewhere / "another.dcm");
  EXPECT_EQ(repeat(recording, elsewhere).different, 0U) << "though a registration there says otherwise";
}

/// Of a file that another program rewrote after it was read, the recording names what was felt.
TEST(RegisteredReplay, IsOfTheStructureThatWasRead) {
  const TestFolder folder;
  const fs::path study = folder / "study", elsewhere = folder / "elsewhere";
  testing::write_contours(study / "rt.dcm", "1.2", "7", "Doe^Jane");
  testing::write_registration(study / "reg.dcm");
  const Recording recording = record(study, folder / "felt.h5", [&] {
    fs::create_directories(elsewhere);
    fs::copy_file(study / "rt.dcm", elsewhere / "as_it_was.dcm");
    testing::move_corner(study / "rt.dcm");
  });
  EXPECT_THAT(recording.scenes.at(0).scene, HasSubstr(hash_of_file(elsewhere / "as_it_was.dcm")));
  EXPECT_EQ(repeat(recording, elsewhere).different, 0U);
  try {
    repeat(recording, study);
    FAIL() << "was repeated with another outline";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("the file that it was felt from is not here"));
  }
}

TEST(RegisteredReplay, TellsWhichRegistrationItWas) {
  const TestFolder folder;
  const fs::path study = folder / "study";  // registrations are looked for beside it, too
  testing::write_contours(study / "rt.dcm", "1.2", "7", "Doe^Jane");
  testing::write_registration(study / "reg.dcm", turned);
  const Recording recording = record(study, study / "felt.h5");
  ASSERT_EQ(registered_of(recording).size(), 1U);
  const RegisteredStructure registered = registered_of(recording).front();
  EXPECT_EQ(registered.structure, "cube");
  EXPECT_EQ(registered.file_hash, hash_of_file(study / "reg.dcm"));
  const glm::dvec3 at(2, 3, 5);
  const glm::dvec3 there(cosine * at.x - sine * at.y + 100.3, sine * at.x + cosine * at.y - 0.7, at.z + 0.1);
  EXPECT_LT(glm::distance(registered.motion(at), there), 1e-9);

  const modes::Scene scene = scene_in(study);
  const auto volume = testing::registered_scan();
  const Summary summary = summarize(recording, *plan_for(scene, *volume, recording.scenes[0].half_extent_m));
  constexpr const char* words = "cube was moved by 100.3, -0.7, 0.1 mm, turned by 20.00 degrees: the registration ";
  EXPECT_THAT(to_text(summary, scene, "a scan", "a stylus"), HasSubstr(words + registered.file_hash));
  EXPECT_THAT(to_json(summary, scene), HasSubstr(registered.file_hash));
}

TEST(RegisteredReplay, OfAnOlderRecordingLooksForTheRegistration) {
  const TestFolder folder;
  const fs::path study = folder / "study";  // registrations are looked for beside it, too
  testing::write_contours(study / "rt.dcm", "1.2", "7", "Doe^Jane");
  testing::write_registration(study / "reg.dcm", turned);
  Recording older = record(study, study / "felt.h5");
  for (SceneRecord& scene : older.scenes) scene.registered.clear();
  write_recording(older, study / "older.h5");
  older = read_recording(study / "older.h5");
  EXPECT_TRUE(registered_of(older).empty());
  EXPECT_EQ(repeat(older, study).different, 0U);
  fs::remove(study / "reg.dcm");
  try {
    repeat(older, study);
    FAIL() << "was repeated";
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("rt.dcm lies in another frame of reference than the scan"));
  }
}

}  // namespace
}  // namespace palpate::plugin
