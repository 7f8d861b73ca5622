/// The setup of a session and its messages: scene and limits from a recording, the file of a fault, the savings by the
/// stylus, and the final line.

#include "plugin/app/run_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/fault_report.h"
#include "plugin/app/live_session.h"
#include "plugin/app/plan_device.h"
#include "plugin/app/recording_header.h"
#include "plugin/session/session.h"
#include "plugin/testing/session_rig.h"
#include "plugin/testing/test_clocks.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

TEST(RunSession, ItsLastLineTellsMissedTicksFromLostOnes) {
  SessionRunResult result;
  result.recorder.written = 2001;
  result.recorder.lost = 17;
  result.missed = 5;
  EXPECT_EQ(in_words(result, "out/a.h5"), "2001 ticks in out/a.h5; missed ticks 5, ticks lost 17");
}

std::shared_ptr<const io::Volume> small_ball() {
  return std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = {50, 46, 42}})));
}

/// A deadline is missed or is a tick: what the session tells of is what its ticks have counted.
TEST(RunSession, TheMissedTicksAreThoseThatTheTicksCount) {
  const auto volume = small_ball();
  const auto held = testing::stylus(testing::hold());
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const auto file = testing::fresh_path("missed.h5");
  const SessionRunResult result =
      run_session({.scene = scene,
                   .felt = prepare(scene, volume, held->specification().workspace_half_extent),
                   .scan_hash = "hash",
                   .stylus = held,
                   .seconds = 0.3},
                  file);
  const Recording recording = read_recording(file);
  EXPECT_EQ(result.recorder.written, recording.ticks.size());
  if (result.recorder.lost > 0) return;  // with them, what they counted
  std::uint64_t missed = 0;
  for (const TickRecord& tick : recording.ticks) missed += tick.missed;
  EXPECT_EQ(result.missed, missed);
}

modes::Scene limited_scene() {
  return modes::scene_from_json(
      R"({"version": 1, "stiffness_n_per_m": 321, "workspace": {"fit": true}, "modes": [{"type": "surface",
      "strength_n": 0.7}], "limits": {"force_limit_n": 1.25, "slew_limit_n_per_ms": 0.4, "ramp_s": 0.35,
      "speed_limit_m_per_s": 0.9}})",
      "test");
}

void expect_limits(const device::SafetyLimits& limits, double device_n) {
  EXPECT_EQ(limits.force, 1.25);
  EXPECT_EQ(limits.device_force, device_n);
  EXPECT_NEAR(limits.slew, 400, 1e-9) << "N/s";
  EXPECT_EQ(limits.ramp_time, 0.35);
  EXPECT_EQ(limits.speed, 0.9);
}

/// A recorded scene is felt again in the reach, with the limits and in the time that it had.
TEST(RunSession, ARecordedScenesSnapshotIsTheOneThatWasFelt) {
  const auto volume = small_ball();
  device::Specification stylus;
  stylus.name = "a stylus";
  stylus.rate = 4000;
  stylus.workspace_half_extent = {0.009, 0.015, 0.007};
  stylus.maximum_force = 6.5;
  const modes::Scene scene = limited_scene();
  const PreparedScene felt = prepare(scene, volume, stylus.workspace_half_extent);
  const Snapshot first = snapshot_of(scene, felt, stylus);
  expect_limits(first.limits, 6.5);
  EXPECT_EQ(first.change_s, 0.35);
  SceneRecord record = record_of(scene, felt, stylus, "hash");
  EXPECT_EQ(record.half_extent_m, stylus.workspace_half_extent);
  EXPECT_EQ(record.maximum_force_n, 6.5);
  EXPECT_EQ(record.scan_hash, "hash");
  record.change_s = 0.125;
  const Snapshot again = snapshot_of(record, volume);
  expect_limits(again.limits, 6.5);
  EXPECT_EQ(again.change_s, 0.125);
  EXPECT_EQ(again.plan->workspace, felt.plan->workspace);
  EXPECT_EQ(again.plan->stiffness_n_per_m, 321);
  EXPECT_NE(again.plan->workspace, plan_for(scene, *volume, {0.08, 0.06, 0.06})->workspace) << "another reach";
  const RecordingHeader header = header_for(scene, stylus, "hash", 7);
  EXPECT_EQ(header.rate_hz, 4000);
  EXPECT_EQ(header.seed, 7);
  EXPECT_EQ(header.device, "a stylus");
  EXPECT_EQ(header.scan_hash, "hash");
  EXPECT_EQ(header.scene, modes::to_json(scene));
}

/// A step takes the scene's ramp, but not less than the program's shortest; one of the many of a drag takes 20 ms.
TEST(LiveSession, AChangeTakesTheTimeOfItsPace) {
  const auto file = testing::fresh_path("pace.h5");
  LiveSession live;
  live.set_clock([](double period_s) { return std::make_unique<testing::UnhurriedClock>(period_s); });
  modes::Scene scene = limited_scene();
  live.set_scan(small_ball(), scene);
  live.connect(testing::stylus(testing::hold()));
  live.record(file);
  std::vector<double> wanted_s{0.35};
  for (const auto& [ramp_s, pace, takes_s] :
       {std::tuple{0.3, Pace::stepped, 0.3}, {0.3, Pace::dragged, 0.02}, {0.01, Pace::stepped, 0.25}}) {
    scene.limits.ramp_s = ramp_s;
    live.set_scene(scene, pace);
    wanted_s.push_back(takes_s);
  }
  live.disconnect();
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.scenes.size(), wanted_s.size());
  for (std::size_t n = 0; n < wanted_s.size(); ++n) EXPECT_EQ(recording.scenes[n].change_s, wanted_s[n]) << n;
}

/// Each takes its part of the ramp by the force that it may change, but not less than a small one and not more than all
/// of it: a drag is no faster way to a force than a ramp.
TEST(LiveSession, ALargeStepOfADragTakesItsPartOfTheRamp) {
  const auto file = testing::fresh_path("drag.h5");
  LiveSession live;
  live.set_clock([](double period_s) { return std::make_unique<testing::UnhurriedClock>(period_s); });
  modes::Scene scene = limited_scene();
  scene.limits.force_n = 2;
  scene.limits.ramp_s = 0.4;
  const auto gate = [](double factor) {
    return std::vector<modes::Gate>{{.factor = modes::TransferFunction({{0, 0}, {100, factor}})}};
  };
  const auto flat = [](double n) { return modes::TransferFunction({{0, n}, {100, n}}); };
  scene.modes.resize(1);
  scene.modes[0].strength_n = flat(0.5);
  scene.modes[0].gates = gate(1);
  live.set_scan(small_ball(), scene);
  live.connect(testing::stylus(testing::hold()));
  live.record(file);
  std::vector<double> wanted_s;
  const auto drag = [&](double change_n) {
    live.set_scene(scene, Pace::dragged);
    wanted_s.push_back(std::clamp(0.4 * change_n / 2, 0.02, 0.4));
  };
  double before_n = 0.5;
  for (const double n : {0.51, 0.45, 0.6, 1.1, 0.3, 1.9, 0.0, 5.0, 1.5}) {
    scene.modes[0].strength_n = flat(n);
    drag(std::abs(n - std::exchange(before_n, n)));
  }
  scene.modes[0].gates = gate(0.6);
  drag(0.4 * 1.5);
  scene.modes[0].strength_n = modes::TransferFunction({{0, 1.5}, {50, 0.7}, {100, 1.5}});
  drag(0.8);
  scene.modes[0].strength_n = flat(1.5);
  drag(0.8);
  scene.modes[0].strength_n = modes::TransferFunction({{20, 1.5}, {100, 1.5}});
  drag(0);
  scene.modes[0].enabled = false;
  drag(1.5);
  live.disconnect();
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.scenes.size(), wanted_s.size() + 1);
  for (std::size_t n = 0; n < wanted_s.size(); ++n) {
    EXPECT_NEAR(recording.scenes[n + 1].change_s, wanted_s[n], 1e-12) << n;
  }
}

/// The second before a fault, under the names of its columns: every number is another.
TEST(FaultFile, EveryColumnHoldsWhatItIsNamedAfter) {
  const auto folder = std::filesystem::absolute(testing::fresh_path("fault_columns"));
  setenv("XDG_STATE_HOME", folder.c_str(), 1);
  device::SafetyTick before;
  before.input = {.time = 1.5,
                  .reading = {.position = {2, 3, 4}, .fresh = true},
                  .device = device::State::active,
                  .force = {6, 7, 8}};
  before.result = {.force = {9, 10, 11}, .speed = 12, .gain = 0.25};
  device::SafetyTick faulty = before;
  faulty.input.reading.fresh = false;
  faulty.result = {.force = {0, -30, 40}, .fault = device::Fault::device_lost, .speed = 13, .gain = 0.125};
  device::SafetyTick after = faulty;  // what comes then does not count
  after.result.force = {1000, 0, 0};
  after.result.speed = 2000;
  const auto kept = keep_fault(std::vector{before, faulty, after}, "a stylus");
  unsetenv("XDG_STATE_HOME");
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->fastest_m_per_s, 13);
  EXPECT_NEAR(kept->strongest_n, 50, 1e-12);
  EXPECT_EQ(kept->fault, "device lost");
  EXPECT_THAT(static_cast<const std::string&>(describe(*kept)),
              ::testing::HasSubstr("moved at up to 13.00 m/s and got up to 50.00 N;"));
  std::ifstream stream(kept->file);
  std::string text;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("# time")) text += line + "\n";
  }
  const std::string lost = std::string(device::name_of(device::State::active)) + ",2,3,4,";
  EXPECT_EQ(text,
            "# stylus: a stylus\n# fault: device lost\n# fastest: 13.000 m/s\n# strongest: 50.000 N\n"
            "time_s,stylus_state,x_m,y_m,z_m,fresh,speed_m_per_s,asked_x_n,asked_y_n,asked_z_n,sent_x_n,sent_y_n,"
            "sent_z_n,gain,fault\n"
            "1.500000," +
                lost + "1,12,6,7,8,9,10,11,0.25," + device::name_of(device::Fault::none) + "\n1.500000," + lost +
                "0,13,6,7,8,0,-30,40,0.125,device lost\n1.500000," + lost +
                "0,2000,6,7,8,1000,0,0,0.125,device lost\n");
}

/// What is left out because of a stylus: the drivers of all others, a guardian where none is needed, damping where
/// nothing can ring.
TEST(SavingsOfDevice, AreWhatTheStylusDoesNotNeed) {
  const auto why = [](const std::string& device, int force_axes) {
    device::Specification specification;
    specification.force_axes = force_axes;
    std::vector<std::pair<std::string, std::string>> all;
    for (const Saving& saving : savings_of_device(device, specification)) all.emplace_back(saving.what, saving.why);
    return all;
  };
  using ::testing::ElementsAre;
  using ::testing::Pair;
  EXPECT_THAT(why("simulated", 3),
              ElementsAre(Pair("drivers of falcon, wooden_haptics, space_mouse, haply, touch, force_dimension",
                               "the stylus is simulated"),
                          Pair("guardian", "a simulated stylus pushes nobody")));
  EXPECT_THAT(why("falcon", 3),
              ElementsAre(Pair("drivers of wooden_haptics, space_mouse, haply, touch, force_dimension",
                               "another stylus is held")));
  EXPECT_THAT(
      why("space_mouse@1", 0),
      ElementsAre(Pair("drivers of falcon, wooden_haptics, haply, touch, force_dimension", "another stylus is held"),
                  Pair("guardian", "the stylus has no motors"),
                  Pair("damping of ringing", "the stylus has no motors")));
}

}  // namespace
}  // namespace palpate::plugin
