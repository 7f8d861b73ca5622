// Every fault on every device, through the one safety filter: what becomes of the force on the device, and how fast.
// What is told is the force that the fake exerts, not what the session thinks of it. The test prints the table; the
// rows of signals are in the tests device.usb.*, which need a process to end.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "device/safety/safety_filter.h"
#include "device/testing/fake_rigs.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::device {
namespace {

constexpr double goes_on = std::numeric_limits<double>::infinity();

/// A session at 1 kHz of the rig's own time: reads, filters, writes.
struct Session {
  FakeRig rig;
  SafetyState state;
  SafetyResult result;
  Vec3 asked{0, 1, 0};
  bool scene_runs = true;
  bool servo_runs = true;
  bool commander_lives = true;
  double scene_time = 0;
  double commander_time = 0;
  double before = 0;   // s that the force was on the device while the program stood still
  double started = 0;  // s: of the fault

  explicit Session(const std::string& kind) : rig(make_rig(kind)) {
    rig.stylus->open();
    run(1.1);
    arm(state);
    run(0.7);
  }
  bool pushes() const { return rig.force() != Vec3(0); }
  bool has_motors() const { return rig.type->has_force; }
  void tick() {
    if (!servo_runs) return;
    SafetyInput input;
    input.time = rig.now();
    input.reading = rig.stylus->read();
    input.device = rig.stylus->state();
    input.force = asked;
    if (scene_runs) scene_time = input.time;
    if (commander_lives) commander_time = input.time;
    input.force_time = scene_time;
    input.heartbeat_time = commander_time;
    result = filter_force(SafetyLimits{}, input, state);
    rig.stylus->write_force(result.force);
  }
  /// Returns for how long after the fault there was a force on the device, s.
  double run(double seconds) {
    const double start = rig.now();
    double next = start;
    double pushed = before;
    while (rig.now() < start + seconds) {
      rig.exchange();
      if (rig.now() >= next) {
        tick();
        next += 1e-3;
      }
      if (pushes()) pushed = rig.now() - started;
    }
    return pushed;
  }
  /// The program stands still; after `zeroed` s its guardian acts.
  void stand_still(double seconds, double zeroed) {
    for (double passed = 0; passed < seconds; passed += 1e-3) {
      if (passed >= zeroed && passed < zeroed + 1e-3 && rig.guardian) rig.guardian();
      rig.pass(1e-3);
      if (pushes()) before = passed + 1e-3;
    }
  }
};

struct Case {
  const char* what;
  std::function<bool(Session&)> cause;  ///< false where this device cannot have it
  double zero_within;                   ///< s; infinity: the force goes on, as it should
  bool reachable = true;                ///< whether anybody can still send it a zero
  double observed = 0.5;                ///< s
  std::string_view borne_by = {};       ///< the kind of device to which it does nothing
};

bool apply(const std::function<void()>& fault) {
  if (fault) fault();
  return static_cast<bool>(fault);
}

Case late(const char* what, double delay, double zero_within) {
  return {what,
          [delay](Session& session) {
            if (session.rig.delay) session.rig.delay(delay);
            return static_cast<bool>(session.rig.delay);
          },
          zero_within, true, 1.5 + 2 * delay};
}

/// The guardian looks every 20 ms and acts after ten looks without a sign of life; then it has to open the device.
constexpr double guardian_s = 0.24;

std::vector<Case> cases() {
  return {
      {"unplugged in mid-motion", [](Session& s) { return apply(s.rig.unplug); }, 0.6, false, 1},
      {"silent", [](Session& s) { return apply(s.rig.silence); }, 0.6, false, 1},
      {"short or split packets", [](Session& s) { return apply(s.rig.shorten); }, goes_on},
      {"half messages", [](Session& s) { return apply(s.rig.halve); }, 0.6, true, 1},
      // Of the Haply's many messages half are enough, and each is whole or nothing.
      {"every second packet garbled", [](Session& s) { return apply(s.rig.garble); }, 0.6, true, 1, "haply"},
      {"a pose that cannot be", [](Session& s) { return apply(s.rig.impossible); }, 0.025},
      late("answers 1 ms late", 1e-3, goes_on),
      late("answers 10 ms late", 10e-3, 0.6),
      late("answers 100 ms late", 0.1, 0.25),
      late("answers 1000 ms late", 1.0, 2.1),
      {"NaN from above",
       [](Session& s) {
         s.asked.x = std::numeric_limits<double>::quiet_NaN();
         return true;
       },
       0.005},
      {"scene thread stalled", [](Session& s) { return !(s.scene_runs = false); }, 0.02},
      {"servo thread stalled",
       [](Session& s) {
         s.servo_runs = false;
         return !s.rig.is_arithmetic();  // which has no time but the servo's
       },
       0.05},
      {"overspeed: the hand at 3 m/s",
       [](Session& s) {
         if (s.rig.fling) s.rig.fling(Vec3(3, 0, 0));
         return static_cast<bool>(s.rig.fling);
       },
       0.1},
      {"lost home", [](Session& s) { return apply(s.rig.unhome); }, 0.15},
      {"stopped process, guardian",
       [](Session& s) {
         s.stand_still(2, guardian_s);
         return !s.rig.is_arithmetic();
       },
       0.26},
      {"stopped process, no guardian",
       [](Session& s) {
         s.stand_still(2, goes_on);
         return !s.rig.is_arithmetic();
       },
       goes_on, false},
      {"suspend for 30 s",
       [](Session& s) {
         put_rigs_to_sleep(30);
         return !s.rig.is_arithmetic();  // which no machine's sleep moves
       },
       0.06},
      {"dead UI", [](Session& s) { return !(s.commander_lives = false); }, 2.6, true, 3},
  };
}

/// What the device does where nobody reaches it, by its fake: s; infinity where it holds its force.
double own_watchdog_s(const std::string& kind) {
  if (kind == "wooden_haptics") return 0.55;
  if (kind == "haply" || kind == "minverse") return 0.05;  // the service's; how long is not published
  if (kind == "force_dimension") return 0.035;
  if (kind == "simulated") return 0.55;  // only "unplugged", which frees its arm
  return goes_on;
}

/// The line of the table for one fault on one device, held against what it should be.
void play(const std::string& kind, const Case& one) {
  Session session(kind);
  const std::string where = name_of_rig(kind) + ": " + one.what;
  ASSERT_EQ(session.result.state, State::active) << where;
  ASSERT_EQ(session.pushes(), session.has_motors()) << where;
  session.started = session.rig.now();
  if (!one.cause(session)) return;
  const double pushed = session.run(one.observed);
  const bool quiet = !session.pushes();
  char time[48];
  std::snprintf(time, sizeof time, quiet ? "%.0f ms" : "goes on", pushed * 1e3);
  const bool left_to_itself = !one.reachable && session.has_motors();
  std::printf("%-22s %-29s %-10s %-13s %s%s%s\n", name_of_rig(kind).c_str(), one.what,
              session.has_motors() ? time : "no motors", name_of(session.result.state), name_of(session.result.fault),
              left_to_itself ? ", its own watchdog: " : "",
              left_to_itself ? std::string(session.rig.type->watchdog).c_str() : "");
  EXPECT_EQ(session.rig.torques(), 0) << where << ": a torque was asked for";
  if (!session.has_motors()) return;
  if (one.reachable && (one.zero_within == goes_on || one.borne_by == session.rig.type->kind)) {
    EXPECT_FALSE(quiet) << where;
    EXPECT_EQ(session.result.fault, Fault::none) << where;
  } else if (one.reachable) {
    EXPECT_TRUE(quiet) << where;
    EXPECT_LE(pushed, one.zero_within) << where;
  } else if (std::string(one.what).find("no guardian") != std::string::npos) {
    // The force stays as long as the device lets it: until the program goes on, and then it is gone at once.
    EXPECT_NEAR(pushed, std::min(own_watchdog_s(kind), 2.0), 0.06) << where;
    EXPECT_TRUE(quiet) << where;
  } else {
    // Nobody can send it a zero: what the table tells is the force that stays on the device.
    EXPECT_EQ(session.result.state, State::fault) << where;
    EXPECT_EQ(session.result.force, Vec3(0)) << where;
    const bool keeps_it = session.rig.is_arithmetic() && std::string(one.what) == "silent";  // a rehearsed fault
    EXPECT_EQ(quiet, own_watchdog_s(kind) < goes_on && !keeps_it) << where;
  }
}

class FaultTable : public ::testing::TestWithParam<const char*> {};

TEST_P(FaultTable, EveryFaultEndsWithoutForce) {
  const auto kinds = rig_kinds();
  const auto place = static_cast<std::size_t>(std::ranges::find(kinds, std::string_view(GetParam())) - kinds.begin());
  if (place == 0) std::printf("%-22s %-29s %-10s %-13s %s\n", "device", "fault", "force for", "state", "cause");
  std::size_t turn = place;
  for (const Case& one : cases()) {
    // Under sanitizers a third of them, each fault on some device and each device with some fault.
    if (!is_sanitized || turn++ % 3 == 0) play(GetParam(), one);
  }
  if (place + 1 < kinds.size()) return;
  std::puts("SIGINT, SIGTERM and SIGKILL: the guardian sends the zeros; tests device.usb.* and GuardianOfProcess.*");
}

INSTANTIATE_TEST_SUITE_P(EachDevice, FaultTable, ::testing::ValuesIn(rig_kinds()),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace palpate::device
