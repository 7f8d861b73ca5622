/// The overwritten line of a running session: each number in its place and unit.

#include "plugin/report/live_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "device/safety/safety_filter.h"
#include "plugin/session/session.h"
#include "plugin/session/tick_ring.h"
#include "solver/exact.h"
#include "solver/solution.h"

namespace palpate::plugin {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

TickRecord record() {
  TickRecord record;
  record.time_s = 12.34;
  record.sent_n[0] = 0.3;
  record.sent_n[2] = -0.4;  // 0.5 N together
  record.force_n[1] = 9;    // not what is sent
  record.probe_m[1] = -0.008;
  record.proxy_m[1] = -0.002;  // 6 mm deep
  record.error_bound_m = 3e-15;
  record.solver = solver::number_of(&solver::exact_solver);
  record.safety = pack_safety(device::State::active, device::Fault::none);
  return record;
}

TEST(LiveLine, HasEachNumberInItsPlace) {
  EXPECT_EQ(live_line(record(), "bone", 45.6, 7),
            "   12.3 s   0.50 N    6.0 mm deep  bone           exact      +-3e-15 m  tick   45.6 us  missed 7");
}

TEST(LiveLine, SaysWhatIsWrong) {
  TickRecord faulty = record();
  faulty.safety = pack_safety(device::State::fault, device::Fault::speed_exceeded);
  EXPECT_THAT(live_line(faulty, "bone", 1, 0), EndsWith("missed 0  FAULT: speed exceeded"));
  TickRecord ramping = record();
  ramping.safety = pack_safety(device::State::ramping, device::Fault::none);
  EXPECT_THAT(live_line(ramping, "bone", 1, 0), EndsWith("missed 0  " + std::string(name_of(device::State::ramping))));
}

TEST(TissueName, IsTheScenesOrCtsOrTheValue) {
  modes::Scene scene;
  EXPECT_EQ(tissue_name(scene, "HU", std::nan("")), "outside");
  EXPECT_EQ(tissue_name(scene, "HU", -1000), "air");
  EXPECT_EQ(tissue_name(scene, "HU", 1e5), "metal");
  EXPECT_EQ(tissue_name(scene, "", 123.4), "value 123");
  scene.tissues = {{"dark", 0, 10, 1, ""}, {"bright", 10, 20, 1, ""}};
  EXPECT_EQ(tissue_name(scene, "HU", 0), "dark");
  EXPECT_EQ(tissue_name(scene, "", 10), "dark") << "the first that holds it";
  EXPECT_EQ(tissue_name(scene, "", 20), "bright");
  EXPECT_EQ(tissue_name(scene, "", 20.5), "value 20");
  EXPECT_EQ(tissue_name(scene, "", -3), "value -3") << "below all of them";
}

/// What is written over: of the newest tick, with the longest of the times since the line before, and all deadlines
/// that were missed so far.
TEST(LiveView, TellsTheNewestTickTheLongestTimeAndAllThatWasMissed) {
  TickRing ring(64);
  const modes::Scene scene;
  const auto push = [&](double time_s, double us, std::uint32_t missed) {
    TickRecord tick = record();
    tick.time_s = time_s;
    tick.value = -1000;
    tick.stage_ns[3] = static_cast<std::uint32_t>(1e3 * us);
    tick.missed = missed;
    ring.push(tick, {});
  };
  ::testing::internal::CaptureStderr();
  {
    LiveView view(ring, scene, "HU");
    view.show();  // nothing yet
    push(1, 20, 2);
    push(2, 90, 3);
    push(3, 30, 0);
    view.show();
    push(4, 7, 10);
    view.show();
    view.show();  // nothing new
  }
  const auto line = [](double time_s, double us, std::uint64_t missed) {
    TickRecord tick = record();
    tick.time_s = time_s;
    return "\r" + live_line(tick, "air", us, missed) + "\033[K";
  };
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), line(3, 90, 5) + line(4, 7, 15) + "\r\033[K");
}

}  // namespace
}  // namespace palpate::plugin
