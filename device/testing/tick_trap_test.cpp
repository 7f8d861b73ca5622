// Operations forbidden in a servo tick: allocations, frees, locks and system calls.

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "device/falcon/falcon_driver.h"
#include "device/safety/energy.h"
#include "device/safety/fault_log.h"
#include "device/safety/safety_filter.h"
#include "device/simulated/replay_stylus.h"
#include "device/simulated/simulated_stylus.h"
#include "device/testing/fake_falcon_link.h"
#include "device/testing/tick_trap.h"

namespace palpate::device {
namespace {

/// What `ticks` ticks of a stylus through damping and the safety filter do that they may not, faults and all.
std::string caught_in(Stylus& stylus, int ticks) {
  const auto log = std::make_unique<FaultLog>();
  SafetyState state;
  EnergyState energy;
  const SafetyLimits limits;
  const TrapCounts before = trap_counts();
  for (int i = 0; i < ticks; ++i) {
    const TickTrap trap;
    SafetyInput input;
    input.time = i * 1e-3;
    input.reading = stylus.read();
    input.device = stylus.state();
    input.force = damp_ringing({}, input.reading, Vec3(0, i % 700 == 699 ? std::nan("") : 1, 0), energy);
    input.force_time = input.heartbeat_time = input.time;
    if (i % 300 == 0) {
      clear_fault(state);
      arm(state);
    }
    const SafetyResult result = filter_force(limits, input, state);
    log->record(input, result);
    stylus.write_force(result.force);
  }
  TrapCounts caught = trap_counts();
  caught.allocations -= before.allocations;
  caught.frees -= before.frees;
  caught.locks -= before.locks;
  caught.system_calls -= before.system_calls;
  return describe(caught);
}

TEST(TickTrap, CatchesWhatATickMayNotDo) {
  const bool system_calls = prepare_tick_trap();
  const TrapCounts before = trap_counts();
  std::mutex mutex;
  {
    const TickTrap trap;
    const auto one = std::make_unique<int>(1);
    const std::lock_guard lock(mutex);
  }
  EXPECT_EQ(trap_counts().allocations, before.allocations + 1);
  EXPECT_EQ(trap_counts().frees, before.frees + 1);
  EXPECT_EQ(trap_counts().locks, before.locks + 1);
  if (!system_calls)
    GTEST_SKIP() << "this kernel cannot trap system calls (needs Linux 5.11 with syscall user dispatch)";
  {
    const TickTrap trap;
    usleep(1);
  }
  EXPECT_EQ(trap_counts().system_calls, before.system_calls + 1);
  EXPECT_GE(trap_counts().last_system_call, 0);
}

TEST(TickTrap, CatchesNothingInAnyStylusTick) {
  prepare_tick_trap();
  SimulatedStylus simulated;
  const Waypoint path[] = {{0, {0, 0, 0}}, {1, {0.02, 0, 0}}};
  simulated.follow(path);
  simulated.open();
  EXPECT_EQ(caught_in(simulated, 2000), "");

  const Reading readings[] = {{0, {0, 0, 0}, 0, true}, {0.001, {0, 0, 0}, 0, true}};
  ReplayStylus replayed(readings);
  replayed.open();
  EXPECT_EQ(caught_in(replayed, 2000), "");

  FakeFalconBench fake;
  LinkStylusOptions options;
  options.threaded = false;
  const auto falcon = make_falcon_on(
      {}, [&] { return std::make_unique<FakeFalconLink>(fake); }, options);
  falcon->open();
  while (falcon->state() == State::homing) falcon->service(1e-3);
  EXPECT_EQ(caught_in(*falcon, 2000), "");
}

}  // namespace
}  // namespace palpate::device
