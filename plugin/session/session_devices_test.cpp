// A session on each device's fake: a scene on a scan, through the one safety filter, recorded and replayed.

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "device/testing/fake_rigs.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/recording_header.h"
#include "plugin/app/run_session.h"
#include "plugin/recording/recorder.h"
#include "plugin/recording/replay.h"
#include "plugin/session/scan_hash.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// From 8 mm above the ball to 6 mm into it, and back.
const std::vector<device::Waypoint> press_on_ball{
    {0, {0, 0, 0}}, {1.5, {0, -0.014, 0}}, {2.5, {0, -0.014, 0}}, {3.5, {0, 0, 0}}};

struct Felt {
  std::uint64_t ticks = 0;
  double strongest_sent_n = 0;
  double strongest_on_device_n = 0;
  device::Fault fault = device::Fault::none;
  glm::dquat turned{0, 0, 0, 0};
  int orientation_axes = 0;
};

class SessionOnDevices : public ::testing::TestWithParam<const char*> {
 protected:
  SessionOnDevices() {
    volume_ = std::make_shared<const io::Volume>(
        testdata::scan(testdata::make_sphere(25), testdata::make_geometry({.size = glm::ivec3(50)})));
    scene_ = modes::load_scene("ct-skin-and-bone");
    scene_.workspace.center_mm = glm::dvec3(0, 0, 33);
    scene_.workspace.scale = 1;
    scene_.workspace.fit = false;
  }

  Felt record(const std::filesystem::path& file) {
    const device::FakeRig rig = device::make_rig(GetParam(), press_on_ball);
    const device::Specification specification = rig.stylus->specification();
    scene_.stiffness_n_per_m = stiffness_for(scene_, specification);
    const std::string hash = hash_of(*volume_);
    const PreparedScene felt = prepare(scene_, volume_, specification.workspace_half_extent);
    TickRing ring;
    Recorder recorder(ring, file, header_for(scene_, specification, hash));
    recorder.note(record_of(scene_, felt, specification, hash));
    recorder.note(StylusRecord{.epoch = 0,
                               .name = specification.name,
                               .force_axes = specification.force_axes,
                               .maximum_force_n = specification.maximum_force});
    Session session(snapshot_of(scene_, felt, specification), rig.stylus, &ring);
    Felt result;
    const double begun = rig.now();
    for (double next = begun; rig.now() < begun + 5.0;) {
      rig.exchange();
      result.strongest_on_device_n = std::max(result.strongest_on_device_n, glm::length(rig.force()));
      if (rig.now() < next) continue;
      next += 1e-3;
      const double time = 1e-3 * static_cast<double>(result.ticks++);
      const TickRecord& tick = session.tick({.time_s = time, .heartbeat_s = time});
      result.strongest_sent_n = std::max(result.strongest_sent_n, glm::length(vector_of(tick.sent_n)));
      if (result.ticks % 256 == 0) recorder.wait_for_room();
    }
    result.fault = session.fault();
    result.turned = session.orientation();
    result.orientation_axes = rig.stylus->specification().orientation_axes;
    EXPECT_EQ(rig.torques(), 0);
    EXPECT_FALSE(recorder.finish().stopped);
    return result;
  }

  std::shared_ptr<const io::Volume> volume_;
  modes::Scene scene_;
};

TEST_P(SessionOnDevices, FeelsTheScanAndIsReplayedToTheLastBit) {
  const auto file = testing::fresh_path(std::string("device_") + GetParam() + ".h5");
  const Felt felt = record(file);
  EXPECT_EQ(felt.fault, device::Fault::none);
  if (device::make_rig(GetParam()).type->has_force) {
    EXPECT_GT(felt.strongest_sent_n, 0.3);
    // The fake exerts what was sent, as far as its motors' and messages' steps go.
    EXPECT_NEAR(felt.strongest_on_device_n, felt.strongest_sent_n, 0.03 + 0.02 * felt.strongest_sent_n);
  } else {
    EXPECT_EQ(felt.strongest_on_device_n, 0);
  }
  // The fake VerseGrip is turned by a quarter about up; the Touch is upright; the others do not tell.
  const bool has_grip = std::string(GetParam()) == "haply" || std::string(GetParam()) == "minverse";
  const glm::dvec3 right = felt.turned * glm::dvec3(1, 0, 0);
  EXPECT_LT(glm::distance(right, has_grip ? glm::dvec3(0, 0, -1) : glm::dvec3(1, 0, 0)), 1e-9);
  EXPECT_EQ(felt.orientation_axes, has_grip || std::string(GetParam()) == "touch" ? 3 : 0);
  const Recording recording = read_recording(file);
  const Replay again = replay(recording, [&](const SceneRecord& record) { return snapshot_of(record, volume_); });
  EXPECT_EQ(again.ticks, felt.ticks);
  EXPECT_EQ(again.different, 0U);
  EXPECT_EQ(again.after_gap, 0U);
}

INSTANTIATE_TEST_SUITE_P(EachFake, SessionOnDevices,
                         ::testing::ValuesIn(device::rig_kinds().begin(), device::rig_kinds().end()),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace palpate::plugin
