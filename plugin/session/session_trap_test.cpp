// The servo tick allocates, frees and locks nothing and makes no system call, whatever goes on around it: a scan with a
// worker that fills bricks, a recorder, a commander that changes scenes, scans and styluses, faults.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <glm/geometric.hpp>
#include <thread>

#include "device/testing/tick_trap.h"
#include "io/fields/volume_fields.h"
#include "plugin/recording/recorder.h"
#include "plugin/testing/session_rig.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using namespace testing;

/// A ball of soft tissue with a core of bone, as voxels with bricks computed in the background.
std::shared_ptr<const io::FieldSource> ball_with_core() {
  testdata::Phantom phantom = testdata::make_sphere(25);
  phantom.bodies.push_back(testdata::make_sphere(15, testdata::bone_hu).bodies.front());
  const auto volume =
      std::make_shared<const io::Volume>(testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(64)})));
  return std::make_shared<const io::VolumeFields>(volume, io::FieldSet::value | io::FieldSet::gradient, 1.5);
}

/// From the air through the skin to the bone of the ball, and around.
std::vector<device::Waypoint> through_the_ball() {
  return {{.time = 0, .position = {0, 0.03, 0}},       {.time = 1, .position = {0, 0.021, 0}},
          {.time = 1.5, .position = {0.02, 0.014, 0}}, {.time = 2, .position = {0, 0.009, 0}},
          {.time = 2.5, .position = {0.01, 0.02, 0}},  {.time = 3, .position = {0, 0.03, 0}}};
}

TEST(SessionTrap, NothingIsCaughtInASessionInWhichEverythingHappens) {
  TickRing ring(8192);
  const auto file = fresh_path("trap.h5");
  Recorder recorder(ring, file, {});
  const auto held = stylus(through_the_ball());
  Session session(snapshot("ct-skin-and-bone", ball_with_core()), held, &ring);
  const std::shared_ptr<const io::FieldSource> others[] = {ball_with_core(), slab(), ball_with_core()};
  std::atomic<bool> done{false};
  // The controlling thread: it goes by the ticks that it sees, not by the clock.
  std::thread commander([&] {
    std::uint64_t next = 300;
    for (int what = 0; !done; ++what) {
      while (!done && ring.written() < next) std::this_thread::sleep_for(std::chrono::microseconds(200));
      next += 300;
      switch (what % 5) {
        case 0:
          session.publish(snapshot("ct-bone", others[0], 0.1));
          break;
        case 1:
          session.publish(snapshot("ct-skin-and-bone", others[1], 0.1));
          break;
        case 2:
          session.change_stylus(stylus(through_the_ball(), 7));
          break;
        case 3:
          session.clear_fault();
          session.arm();
          break;
        default:
          session.publish(snapshot("ct-skin-and-bone", others[2], 0.1));
          session.collect();
          break;
      }
    }
  });
  const bool all = device::prepare_tick_trap();
  const device::TrapCounts before = device::trap_counts();
  double most = 0;
  for (int n = 0; n < 10000; ++n) {
    if (n % 3000 == 2999) held->inject(device::SimulatedFault::not_a_number);
    {
      const device::TickTrap trap;
      const TickRecord& tick = session.tick();
      most = std::max(most, glm::length(vector_of(tick.sent_n)));
    }
    if (n % 20 == 0) {
      recorder.wait_for_room();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the others' turn
    }
  }
  done = true;
  commander.join();
  const device::TrapCounts& caught = device::trap_counts();
  EXPECT_EQ(caught.allocations - before.allocations, 0);
  EXPECT_EQ(caught.frees - before.frees, 0);
  EXPECT_EQ(caught.locks - before.locks, 0);
  EXPECT_EQ(caught.system_calls - before.system_calls, 0) << "the last is number " << caught.last_system_call;
  EXPECT_GT(most, 0.5) << "something has to be felt";
  EXPECT_EQ(recorder.finish().lost, 0U);
  const Recording recording = read_recording(file);
  EXPECT_GT(recording.ticks.back().scene_epoch, 5U);
  EXPECT_GT(recording.ticks.back().stylus_epoch, 2U);
  if (!all) GTEST_SKIP() << "all held but that no system call is made: this kernel cannot trap them (needs Linux 5.11)";
}

}  // namespace
}  // namespace palpate::plugin
