#include "plugin/app/live_session.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <thread>

#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/run_session.h"
#include "plugin/testing/session_rig.h"
#include "plugin/testing/test_clocks.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using namespace testing;

std::shared_ptr<const io::Volume> ball(double radius_mm = 25) {
  return std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(radius_mm), testdata::make_geometry({.size = glm::ivec3(60)})));
}

/// A session whose ticks are never late, however busy the machine is.
struct UnhurriedSession : LiveSession {
  UnhurriedSession() {
    set_clock([](double period_s) { return std::make_unique<UnhurriedClock>(period_s); });
  }
};

/// Held 3 mm below the top of the ball.
std::shared_ptr<device::SimulatedStylus> pressing() {
  auto held = std::make_shared<device::SimulatedStylus>();
  held->follow(std::vector<device::Waypoint>{{.time = 0, .position = {0, 0.03, 0}},
                                             {.time = 0.4, .position = {0, 0.022, 0}},
                                             {.time = 1000, .position = {0, 0.022, 0}}});
  return held;
}

TickRecord last_tick(const LiveSession& live) {
  TickRecord tick;
  const std::uint64_t written = live.ticks()->written();
  if (written > 0) live.ticks()->read(written - 1, tick);
  return tick;
}

double sent_n(const LiveSession& live) {
  return glm::length(vector_of(last_tick(live).sent_n));
}

/// Whether it comes to hold within some seconds.
bool comes(LiveSession& live, const std::function<bool()>& holds) {
  for (int n = 0; n < 2000; ++n) {
    if (holds()) return true;
    live.heartbeat();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(LiveSession, NeedsAScanBeforeAStylus) {
  UnhurriedSession live;
  live.set_scene(modes::load_scene("ct-skin-and-bone"));
  EXPECT_EQ(live.plan(), nullptr);
  EXPECT_THROW(live.connect(pressing()), std::runtime_error);
  EXPECT_THROW(live.record(fresh_path("nothing.h5")), std::runtime_error);
  EXPECT_FALSE(live.is_connected());
  live.set_scan(ball());
  ASSERT_NE(live.plan(), nullptr);
  EXPECT_EQ(live.plan()->modes.size(), 3U);
}

TEST(LiveSession, FeelsReleasesAndFeelsAgain) {
  UnhurriedSession live;
  live.set_scan(ball());
  live.set_scene(modes::load_scene("ct-skin-and-bone"));
  live.connect(pressing());
  EXPECT_TRUE(comes(live, [&] { return sent_n(live) > 0.3; }));
  live.release();
  EXPECT_TRUE(comes(live, [&] { return sent_n(live) == 0; }));
  live.feel();
  EXPECT_TRUE(comes(live, [&] { return state_of(last_tick(live)) == device::State::active; }));
}

TEST(LiveSession, LetsGoInMidContact) {
  UnhurriedSession live;
  live.set_scan(ball());
  live.set_scene(modes::load_scene("ct-skin-and-bone"));
  live.connect(pressing());
  EXPECT_TRUE(comes(live, [&] { return sent_n(live) > 0.3; }));
  live.disconnect();
  EXPECT_FALSE(live.is_connected());
  EXPECT_EQ(sent_n(live), 0);
}

TEST(LiveSession, AnEditedStrengthNeedsNoNewFields) {
  const auto volume = ball();
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const glm::dvec3 half_extent_m{0.08, 0.06, 0.06};
  const Prepared before{prepare(scene, volume, half_extent_m), scene};
  scene.modes[0].strength_n = modes::TransferFunction(0.5);
  const PreparedScene edited = prepare(scene, volume, half_extent_m, before);
  EXPECT_EQ(edited.source, before.felt.source);
  EXPECT_NE(edited.plan, before.felt.plan);
  EXPECT_NE(prepare(scene, ball(), half_extent_m, before).source, before.felt.source) << "of another scan";
  scene.gradient_scale_mm = 3;
  EXPECT_NE(prepare(scene, volume, half_extent_m, before).source, before.felt.source) << "at another scale";
}

TEST(LiveSession, AnEditIsInTheLoop) {
  UnhurriedSession live;
  live.set_scan(ball());
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  live.set_scene(scene);
  live.connect(pressing());
  ASSERT_TRUE(comes(live, [&] { return sent_n(live) > 0.3; }));
  scene.modes[0].enabled = false;
  live.set_scene(scene, Pace::dragged);
  EXPECT_TRUE(comes(live, [&] { return sent_n(live) < 0.05; })) << "the skin is switched off";
  scene.modes[0].strength_n = {};
  scene.modes[0].enabled = true;
  scene.modes[0].from = "nobody";
  EXPECT_THROW(live.set_scene(scene), std::invalid_argument);
  EXPECT_FALSE(live.scene().modes[0].enabled) << "the last good scene goes on";
}

TEST(LiveSession, GoesOverToAnotherScanAndLetsGoWithoutOne) {
  UnhurriedSession live;
  live.set_scan(ball());
  live.set_scene(modes::load_scene("ct-skin-and-bone"));
  live.connect(pressing());
  ASSERT_TRUE(comes(live, [&] { return sent_n(live) > 0.3; }));
  live.set_scan(ball(15));
  EXPECT_TRUE(comes(live, [&] { return sent_n(live) < 0.05; })) << "the stylus is outside of the smaller ball";
  live.set_scan(nullptr);
  EXPECT_FALSE(live.is_connected());
  EXPECT_EQ(live.plan(), nullptr);
}

TEST(LiveSession, ARecordingIsRepeatedToTheLastBit) {
  const auto file = fresh_path("live.h5");
  UnhurriedSession live;
  const auto volume = ball();
  live.set_scan(volume);
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  live.set_scene(scene);
  live.connect(pressing());
  live.record(file);
  ASSERT_TRUE(comes(live, [&] { return sent_n(live) > 0.3; }));
  scene.modes[0].strength_n = modes::TransferFunction(0.2);
  live.set_scene(scene, Pace::dragged);
  ASSERT_TRUE(comes(live, [&] { return last_tick(live).scene_epoch == 1 && last_tick(live).change_part == 1; }));
  live.release();
  ASSERT_TRUE(comes(live, [&] { return sent_n(live) == 0; }));
  const auto status = live.stop_recording();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->lost, 0U);
  const Recording recording = read_recording(file);
  EXPECT_GT(recording.ticks.size(), 100U);
  const Replay again = replay(recording, [&](const SceneRecord& record) { return snapshot_of(record, volume); });
  EXPECT_EQ(again.ticks, recording.ticks.size());
  EXPECT_EQ(again.different, 0U);
  std::filesystem::remove(file);
}

TEST(LiveSession, ARecordingTellsWhichFrameOfTheSeriesWasFelt) {
  const auto file = fresh_path("ticks.h5");
  LiveSession live;
  const std::array volumes{ball(25), ball(24)};
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  live.set_scan(volumes[0], scene, {.number = 0, .count = 2});
  live.connect(pressing());
  live.record(file);
  ASSERT_TRUE(comes(live, [&] { return sent_n(live) > 0.3; }));
  live.set_scan(volumes[1], scene, {.number = 1, .count = 2});
  ASSERT_TRUE(comes(live, [&] { return last_tick(live).scene_epoch == 1 && last_tick(live).change_part == 1; }));
  modes::Scene edited = scene;
  edited.stiffness_n_per_m *= 0.9;
  live.set_scene(edited);
  ASSERT_TRUE(comes(live, [&] { return last_tick(live).scene_epoch == 2; }));
  ASSERT_TRUE(live.stop_recording());
  const Recording recording = read_recording(file);
  ASSERT_EQ(recording.scenes.size(), 3U);
  EXPECT_EQ(recording.scenes[0].frame, (ScanFrame{0, 2}));
  EXPECT_EQ(recording.scenes[1].frame, (ScanFrame{1, 2}));
  EXPECT_EQ(recording.scenes[2].frame, (ScanFrame{1, 2})) << "an edit leaves the frame as it is";
  const Replay again = replay(recording, [&](const SceneRecord& record) {
    return snapshot_of(record, volumes.at(static_cast<std::size_t>(record.frame->number)));
  });
  EXPECT_EQ(again.ticks, recording.ticks.size());
  EXPECT_EQ(again.different, 0U);
  // The proxy was held: of those ticks it is known how well, and of none on the way to another scan.
  std::size_t told = 0;
  for (std::size_t n = 0; n < recording.ticks.size(); ++n) {
    if (!std::isfinite(recording.known_to_mm[n])) continue;
    ++told;
    EXPECT_EQ(recording.ticks[n].change_part, 1);
  }
  EXPECT_GT(told, 10U);
}

TEST(LiveSession, AFilterIsFeltAndItsRecordingRepeatedToTheLastBit) {
  const auto file = fresh_path("filtered.h5");
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(25), testdata::make_geometry({.size = glm::ivec3(60)}), {.noise = 80}));
  UnhurriedSession live;
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.filter = {.type = io::find_filter_type("gaussian"), .sigma_mm = 1};
  live.set_scan(volume, scene);
  EXPECT_EQ(live.scan(), volume);
  EXPECT_EQ(io::filter_of(*live.felt_scan()), scene.filter);
  const glm::dvec3 inside(1, 2, 3);
  const auto felt = io::VolumeFields(live.felt_scan(), io::FieldSet::value, 1).sample(inside, io::FieldSet::value);
  const auto raw = io::VolumeFields(volume, io::FieldSet::value, 1).sample(inside, io::FieldSet::value);
  EXPECT_NE(felt.value, raw.value);
  live.connect(pressing());
  live.record(file);
  ASSERT_TRUE(comes(live, [&] { return sent_n(live) > 0.3; }));
  scene.filter = {.type = io::find_filter_type("median"), .width = 5};
  const auto ahead = io::filtered(volume, scene.filter);
  live.offer(ahead);
  live.set_scene(scene);
  EXPECT_EQ(live.felt_scan(), ahead);
  ASSERT_TRUE(comes(live, [&] { return last_tick(live).scene_epoch == 1 && last_tick(live).change_part == 1; }));
  scene.filter = {};
  live.set_scene(scene);
  EXPECT_EQ(live.felt_scan(), volume);
  ASSERT_TRUE(comes(live, [&] { return last_tick(live).scene_epoch == 2 && last_tick(live).change_part == 1; }));
  ASSERT_TRUE(live.stop_recording());
  const Recording recording = read_recording(file);
  const Replay again = replay(recording, [&](const SceneRecord& record) { return snapshot_of(record, volume); });
  EXPECT_EQ(again.ticks, recording.ticks.size());
  EXPECT_EQ(again.different, 0U);
  // Of the filters themselves: without them it is another force.
  const Replay without = replay(recording, [&](SceneRecord record) {
    modes::Scene plain = modes::scene_from_json(record.scene, "recording");
    plain.filter = {};
    record.scene = modes::to_json(plain);
    return snapshot_of(record, volume);
  });
  EXPECT_GT(without.different, 0U);
  std::filesystem::remove(file);
}

/// Connects a stylus that presses until it is unplugged; it can be opened again. False if no force or no fault came.
bool presses_and_is_lost(LiveSession& live) {
  live.set_scan(ball(), modes::load_scene("ct-skin-and-bone"));
  const auto held = pressing();
  live.connect(held);
  if (!comes(live, [&] { return sent_n(live) > 0.1; })) return false;
  held->inject(device::SimulatedFault::unplugged);
  const bool lost = comes(live, [&] { return fault_of(last_tick(live)) == device::Fault::device_lost; });
  held->inject(device::SimulatedFault::none);
  return lost;
}

TEST(LiveSession, AStylusThatWasLostComesBackUnarmed) {
  LiveSession live;
  ASSERT_TRUE(presses_and_is_lost(live));
  live.reopen();
  ASSERT_TRUE(live.is_connected());
  ASSERT_TRUE(comes(live, [&] { return live.ticks()->written() > 1000; }));
  EXPECT_EQ(fault_of(last_tick(live)), device::Fault::none);
  EXPECT_EQ(sent_n(live), 0) << "only the user turns the force on";
  EXPECT_EQ(state_of(last_tick(live)), device::State::idle);
  live.feel();
  EXPECT_TRUE(comes(live, [&] { return state_of(last_tick(live)) == device::State::active; }));
}

TEST(LiveSession, ARecordingThatBeginsAfterAFaultHasNoForce) {
  const auto file = fresh_path("after-a-fault.h5");
  UnhurriedSession live;
  ASSERT_TRUE(presses_and_is_lost(live));
  live.record(file);
  EXPECT_EQ(live.start(), LiveSession::Start::released);
  ASSERT_TRUE(comes(live, [&] { return live.ticks()->written() > 1000; }));
  EXPECT_EQ(sent_n(live), 0) << "only the user turns the force on";
  EXPECT_EQ(state_of(last_tick(live)), device::State::idle);
  live.feel();
  EXPECT_TRUE(comes(live, [&] { return state_of(last_tick(live)) == device::State::active; }));
  live.clear_fault();
  EXPECT_EQ(live.start(), LiveSession::Start::released) << "nor does a session that begins after the fault is cleared";
  live.disconnect();
  std::filesystem::remove(file);
}

TEST(LiveSession, AStylusThatIsStillGoneIsSaid) {
  LiveSession live;
  live.set_scan(ball(), modes::load_scene("ct-skin-and-bone"));
  const auto held = pressing();
  live.connect(held);
  held->inject(device::SimulatedFault::unplugged);
  try {
    live.reopen();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "simulated stylus: unplugged; plug it in again");
  }
  EXPECT_FALSE(live.is_connected());
}

/// A stylus that knows what it can do once it is open, as those of makers' libraries do.
class LateStylus final : public device::Stylus {
 public:
  device::Specification specification() const override {
    device::Specification told = inner_.specification();
    if (opened > 0) {
      told.name = "opened";
      told.workspace_half_extent *= 0.5;
      told.maximum_force = 1.5;
      told.stiffness_limit = 123;
    }
    return told;
  }
  void open() override {
    inner_.open();
    ++opened;
  }
  void close() noexcept override {
    inner_.close();
    ++closed;
  }
  device::Reading read() noexcept override { return inner_.read(); }
  void write_force(const device::Vec3& force) noexcept override { inner_.write_force(force); }
  device::State state() const noexcept override { return inner_.state(); }

  int opened = 0, closed = 0;

 private:
  device::SimulatedStylus inner_;
};

/// Force and stiffness of the device that is there are those of the session; it is opened and closed once.
TEST(LiveSession, IsPlannedForTheStylusThatIsThere) {
  const auto late = std::make_shared<LateStylus>();
  const double nominal_m = late->specification().workspace_half_extent.x;
  UnhurriedSession live;
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  live.set_scan(ball(), scene);
  live.connect(late);
  EXPECT_EQ(live.specification().name, "opened");
  EXPECT_EQ(live.specification().workspace_half_extent.x, nominal_m / 2);
  EXPECT_EQ(live.stiffness_n_per_m(), 123);
  EXPECT_EQ(live.drawn_down().size(), 2U) << "the force and the stiffness";
  live.disconnect();
  EXPECT_EQ(late->opened, 1);
  EXPECT_EQ(late->closed, 1);
}

/// A stylus that cannot be planned for is closed again.
TEST(LiveSession, AStylusIsClosedWhereItsSceneCannotBeFelt) {
  for (const bool open : {false, true}) {
    const auto late = std::make_shared<LateStylus>();
    if (open) late->open();
    {
      const OpenStylus held = OpenStylus::of(late);
      EXPECT_EQ(late->opened, 1);
      EXPECT_EQ(held.specification().name, "opened");
    }
    EXPECT_EQ(late->closed, 1);
  }
}

}  // namespace
}  // namespace palpate::plugin
