// The servo tick allocates nothing: operator new is watched while it runs.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>

#include "palpate/device/fault_log.h"
#include "palpate/device/internal/fakes/fake_falcon_link.h"
#include "palpate/device/internal/falcon_driver.h"
#include "palpate/device/replay_stylus.h"
#include "palpate/device/safety_filter.h"
#include "palpate/device/simulated_stylus.h"

namespace {

thread_local bool trapped = false;
thread_local int allocations = 0;

void* allocate(std::size_t size) {
  if (trapped) ++allocations;
  void* memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size);
}
void* operator new[](std::size_t size) {
  return allocate(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

namespace palpate::device {
namespace {

/// Allocations in `ticks` ticks of a stylus through the safety filter, faults and all.
int allocations_of(Stylus& stylus, int ticks, SafetyState& state, FaultLog& log) {
  const SafetyLimits limits;
  allocations = 0;
  trapped = true;
  for (int i = 0; i < ticks; ++i) {
    SafetyInput input;
    input.time = i * 1e-3;
    input.reading = stylus.read();
    input.device = stylus.state();
    input.force = Vec3(0, i % 700 == 699 ? std::nan("") : 1, 0);
    input.force_time = input.heartbeat_time = input.time;
    if (i % 300 == 0) {
      clear_fault(state);
      arm(state);
    }
    const SafetyResult result = filter_force(limits, input, state);
    log.record(input, result);
    stylus.write_force(result.force);
  }
  trapped = false;
  return allocations;
}

TEST(Allocation, TheTrapTraps) {
  allocations = 0;
  trapped = true;
  const auto one = std::make_unique<int>(1);
  trapped = false;
  EXPECT_EQ(allocations, 1);
}

TEST(Allocation, NoTickAllocates) {
  const auto log = std::make_unique<FaultLog>();
  SafetyState state;
  SimulatedStylus simulated;
  const Waypoint path[] = {{0, {0, 0, 0}}, {1, {0.02, 0, 0}}};
  simulated.follow(path);
  simulated.open();
  EXPECT_EQ(allocations_of(simulated, 2000, state, *log), 0);

  const Reading readings[] = {{0, {0, 0, 0}, 0, true}, {0.001, {0, 0, 0}, 0, true}};
  ReplayStylus replayed(readings);
  replayed.open();
  EXPECT_EQ(allocations_of(replayed, 2000, state, *log), 0);

  FakeFalconBench fake;
  LinkStylusOptions options;
  options.threaded = false;
  const auto falcon = make_falcon_on(
      {}, [&] { return std::make_unique<FakeFalconLink>(fake); }, options);
  falcon->open();
  while (falcon->state() == State::homing) falcon->service(1e-3);
  EXPECT_EQ(allocations_of(*falcon, 2000, state, *log), 0);
}

}  // namespace
}  // namespace palpate::device
