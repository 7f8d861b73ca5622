// Every fault on every device with forces, through the safety filter: what becomes of the force, and how fast. The test
// prints the table; the rows of signals are in the tests device.usb.*, which need a process to end.

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "device/falcon/falcon_driver.h"
#include "device/safety/safety_filter.h"
#include "device/simulated/simulated_stylus.h"
#include "device/testing/fake_falcon_link.h"
#include "device/testing/fake_wooden_haptics.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {
namespace {

/// What the faults do to one device; a function that is empty is a fault that this device cannot have.
struct Rig {
  std::string name;
  std::string watchdog;  ///< of the device's own, where nobody can reach it
  bool own_watchdog = false;
  std::shared_ptr<Stylus> stylus;
  std::function<double()> now;     ///< s
  std::function<void()> exchange;  ///< lets some time go by
  std::function<bool()> is_pushing;
  std::function<void()> unplug, silence, shorten, garble, impossible;
  std::function<void(double)> delay;  ///< s on top of every answer
  std::function<void()> unhome;
  std::function<void(double)> stop;  ///< the program, for some seconds

  bool is_arithmetic() const { return name == "simulated"; }
};

double asleep_s = 0;
double asleep() noexcept {
  return asleep_s;
}

LinkStylusOptions in_this_thread() {
  LinkStylusOptions options;
  options.threaded = false;
  options.asleep = &asleep;
  return options;
}

Rig falcon() {
  auto bench = std::make_shared<FakeFalconBench>();
  std::shared_ptr<LinkStylus> stylus = make_falcon_on(
      {}, [bench] { return std::make_unique<FakeFalconLink>(*bench); }, in_this_thread());
  FakeFalconFaults* const faults = &bench->falcon.faults;
  return {"Falcon",
          "unknown: switch it off",
          false,
          stylus,
          [bench] { return bench->time; },
          [stylus] { stylus->service(0.2e-3); },
          [bench] { return bench->falcon.is_pushing(); },
          [bench] { bench->unplugged = true; },
          [faults] { faults->silent = true; },
          [faults] { faults->most_payload = 3; },
          [faults] { faults->garble_every = 2; },
          [faults] { faults->impossible_pose = true; },
          [faults](double delay) { faults->reply_delay = delay; },
          [faults] { faults->home_lost = true; },
          [bench](double seconds) { bench->time += seconds; }};
}

Rig wooden_haptics() {
  auto bench = std::make_shared<FakeHidBench>();
  FakeWoodenHapticsOptions options;
  auto arm = std::make_shared<FakeWoodenHaptics>(options);
  std::shared_ptr<LinkStylus> stylus = make_wooden_haptics_on(
      options.arm, [arm, bench] { return std::make_unique<FakeHidLink>(*arm, *bench); }, in_this_thread());
  FakeWoodenHapticsFaults* const faults = &arm->faults;
  return {"WoodenHaptics",
          "0.5 s",
          true,
          stylus,
          [bench] { return bench->time; },
          [stylus] { stylus->service(0.2e-3); },
          [arm, bench] { return arm->is_pushing(bench->time); },
          [bench] { bench->unplugged = true; },
          [faults] { faults->silent = true; },
          [faults] { faults->short_every = 10; },
          [faults] { faults->garble_every = 2; },
          [faults] { faults->impossible_pose = true; },
          [faults](double delay) { faults->report_delay = delay; },
          [faults] { faults->button_pressed = true; },
          [bench](double seconds) { bench->time += seconds; }};
}

Rig simulated() {
  auto stylus = std::make_shared<SimulatedStylus>();
  auto time = std::make_shared<double>(0);
  return {"simulated",
          "none",
          false,
          stylus,
          [time] { return *time; },
          [time] { *time += 1e-3; },
          [stylus] { return stylus->acting_force() != Vec3(0); },
          [stylus] { stylus->inject(SimulatedFault::unplugged); },
          [stylus] { stylus->inject(SimulatedFault::stalled); },
          {},
          {},
          [stylus] { stylus->inject(SimulatedFault::not_a_number); },
          {},
          {},
          [time](double seconds) { *time += seconds; }};
}

/// A session at 1 kHz of the rig's own time: reads, filters, writes.
struct Session {
  Rig rig;
  SafetyState state;
  SafetyResult result;
  Vec3 asked{0, 1, 0};
  bool scene_runs = true;
  bool servo_runs = true;
  bool commander_lives = true;
  double carried = 0;  // m/s: as if the hand were thrown to the right
  double scene_time = 0;
  double commander_time = 0;

  explicit Session(const Rig& r) : rig(r) {
    rig.stylus->open();
    run(1.0);
    arm(state);
    run(0.7);
  }
  void tick() {
    if (!servo_runs) return;
    SafetyInput input;
    input.time = rig.now();
    input.reading = rig.stylus->read();
    input.device = rig.stylus->state();
    input.reading.position.x += carried * input.time;
    input.force = asked;
    if (scene_runs) scene_time = input.time;
    if (commander_lives) commander_time = input.time;
    input.force_time = scene_time;
    input.heartbeat_time = commander_time;
    result = filter_force(SafetyLimits{}, input, state);
    rig.stylus->write_force(result.force);
  }
  /// Returns for how long after the start there was a force on the device, s.
  double run(double seconds) {
    const double start = rig.now();
    double next = start;
    double pushed = 0;
    while (rig.now() < start + seconds) {
      rig.exchange();
      if (rig.now() >= next) {
        tick();
        next += 1e-3;
      }
      if (rig.is_pushing()) pushed = rig.now() - start;
    }
    return pushed;
  }
};

struct Case {
  const char* what;
  std::function<bool(Session&)> cause;  ///< false where this device cannot have it
  double zero_within;                   ///< s; infinity: the force goes on, as it should
  bool reachable = true;                ///< whether anybody can still send it a zero
  double observed = 0.5;                ///< s
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

TEST(FaultTable, EveryFaultEndsWithoutForce) {
  constexpr double goes_on = std::numeric_limits<double>::infinity();
  const Case cases[] = {
      {"unplugged in mid-motion", [](Session& s) { return apply(s.rig.unplug); }, 0.6, false, 1},
      {"silent", [](Session& s) { return apply(s.rig.silence); }, 0.6, false, 1},
      {"short or split packets", [](Session& s) { return apply(s.rig.shorten); }, goes_on},
      {"every second packet garbled", [](Session& s) { return apply(s.rig.garble); }, 0.6, true, 1},
      {"a pose that cannot be", [](Session& s) { return apply(s.rig.impossible); }, 0.01},
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
         return s.rig.name != "simulated";  // which has no time but the servo's
       },
       0.03},
      {"hand at 3 m/s",
       [](Session& s) {
         s.carried = 3;
         return true;
       },
       0.1},
      {"home lost", [](Session& s) { return apply(s.rig.unhome); }, 0.01},
      {"program stopped for 1 s",
       [](Session& s) {
         s.rig.stop(1);
         return true;
       },
       0.06},
      {"machine asleep for 30 s",
       [](Session& s) {
         asleep_s += 30;
         return !s.rig.is_arithmetic();  // which no machine's sleep moves
       },
       0.06},
      {"dead UI", [](Session& s) { return !(s.commander_lives = false); }, 2.6, true, 3},
  };

  std::printf("%-14s %-28s %-18s %-16s %s\n", "device", "fault", "no force after", "state", "cause");
  for (const auto& make : {simulated, falcon, wooden_haptics}) {
    for (const Case& one : cases) {
      Session session(make());
      ASSERT_EQ(session.result.state, State::active) << session.rig.name;
      ASSERT_TRUE(session.rig.is_pushing()) << session.rig.name;
      if (!one.cause(session)) continue;
      const double pushed = session.run(one.observed);
      const bool quiet = !session.rig.is_pushing();
      char time[32];
      std::snprintf(time, sizeof time, quiet ? "%.0f ms" : "goes on", pushed * 1e3);
      const bool left_to_itself = !one.reachable && !quiet;
      std::printf("%-14s %-28s %-18s %-16s %s%s\n", session.rig.name.c_str(), one.what, time,
                  name_of(session.result.state), name_of(session.result.fault),
                  left_to_itself ? (", the device's own watchdog: " + session.rig.watchdog).c_str() : "");
      const std::string where = session.rig.name + ": " + one.what;
      if (one.zero_within == goes_on) {
        EXPECT_FALSE(quiet) << where;
        EXPECT_EQ(session.result.fault, Fault::none) << where;
      } else if (one.reachable) {
        EXPECT_TRUE(quiet) << where;
        EXPECT_LE(pushed, one.zero_within) << where;
      } else {
        // Nobody can send it a zero: what the table tells is the force that stays on the device, and that nothing is
        // asked of it any more.
        EXPECT_EQ(session.result.state, State::fault) << where;
        EXPECT_EQ(session.result.force, Vec3(0)) << where;
        EXPECT_TRUE(session.rig.is_arithmetic() || quiet == session.rig.own_watchdog)
            << where << ": with the device's own watchdog or without";
      }
    }
  }
  std::puts("while a program is stopped its guardian sends the zeros: Guardian.*, and tests device.usb.*");
  std::puts("without a guardian, a device is left to its own watchdog: `palpate devices` and the panel say so");
  std::puts("SIGINT, SIGTERM and SIGKILL: the guardian sends the zeros; tests device.usb.*");
}

}  // namespace
}  // namespace palpate::device
