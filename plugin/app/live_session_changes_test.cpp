/// The state that a live session keeps across a change: the scan in its recording, and a fault.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

#include "modes/scene/scene_json.h"
#include "plugin/app/live_session.h"
#include "plugin/session/scan_hash.h"
#include "plugin/testing/session_rig.h"
#include "plugin/testing/test_clocks.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

std::shared_ptr<const io::Volume> small_scan(double radius_mm) {
  return std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(radius_mm), testdata::make_geometry({.size = glm::ivec3(40)})));
}

void beat_until(LiveSession& live, const std::function<bool()>& holds) {
  while (!holds()) {
    live.heartbeat();
    std::this_thread::yield();
  }
}

/// Whichever scan is felt, before the recording or in its midst, is the one that it names.
TEST(LiveSessionChanges, ARecordingNamesEachScanThatWasFelt) {
  const auto file = testing::fresh_path("scans.h5");
  LiveSession live;
  live.set_clock([](double period_s) { return std::make_unique<testing::UnhurriedClock>(period_s); });
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  live.set_scan(small_scan(18), scene);
  live.connect(testing::stylus(testing::hold()));
  live.record(testing::fresh_path("before.h5"));  // for which the first scan is hashed
  live.stop_recording();
  std::vector<std::string> felt;
  const auto feel = [&](const std::shared_ptr<const io::Volume>& volume) {
    live.set_scan(volume, scene);
    felt.push_back(hash_of(*volume));
  };
  feel(small_scan(17));
  live.record(file);
  const auto first = small_scan(16);
  feel(first);
  feel(small_scan(15));
  feel(first);
  live.set_scene(scene);
  felt.push_back(felt.back());
  live.disconnect();
  const Recording recording = read_recording(file);
  EXPECT_EQ(recording.header.scan_hash, felt.front());
  ASSERT_EQ(recording.scenes.size(), felt.size());
  for (std::size_t n = 0; n < felt.size(); ++n) EXPECT_EQ(recording.scenes[n].scan_hash, felt[n]) << n;
}

/// A fault is told of the session that it ended, and its file is written once.
TEST(LiveSessionChanges, AFaultIsKeptOnceAndOfItsOwnSession) {
  const auto folder = std::filesystem::absolute(testing::fresh_path("kept_faults"));
  setenv("XDG_STATE_HOME", folder.c_str(), 1);
  LiveSession live;
  live.set_clock([](double period_s) { return std::make_unique<testing::UnhurriedClock>(period_s); });
  live.set_scan(small_scan(18), modes::load_scene("ct-skin-and-bone"));
  const auto held = testing::stylus(testing::hold());
  for (int session = 0; session < 2; ++session) {
    live.connect(held);
    EXPECT_FALSE(live.last_fault()) << "of another session";
    beat_until(live, [&] { return live.ticks()->written() > 100; });
    held->inject(device::SimulatedFault::unplugged);
    beat_until(live, [&] { return live.last_fault().has_value(); });
    held->inject(device::SimulatedFault::none);
    const auto kept = live.last_fault()->file;
    EXPECT_TRUE(std::filesystem::remove(kept));
    const std::uint64_t then = live.ticks()->written();
    beat_until(live, [&] { return live.ticks()->written() > then + 100; });
    EXPECT_FALSE(std::filesystem::exists(kept)) << "the same fault, once more";
    EXPECT_TRUE(live.last_fault());
  }
  live.disconnect();
  unsetenv("XDG_STATE_HOME");
}

}  // namespace
}  // namespace palpate::plugin
