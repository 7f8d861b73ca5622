// What the device's share of a tick costs: the safety filter, the damping, kinematics both ways, report codecs, and a
// tick of the simulated stylus.
#include <benchmark/benchmark.h>

#include <array>

#include "device/falcon/falcon_kinematics.h"
#include "device/falcon/falcon_protocol.h"
#include "device/safety/energy.h"
#include "device/safety/safety_filter.h"
#include "device/simulated/simulated_stylus.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {
namespace {

void safety_filter(benchmark::State& state) {
  const SafetyLimits limits;
  SafetyState safety;
  SafetyInput input;
  arm(safety);
  double time = 0;
  for (auto _ : state) {
    input.time = input.force_time = input.heartbeat_time = input.reading.time = time += 1e-3;
    input.reading.position.x = 1e-5 * static_cast<double>(static_cast<int>(time * 1e3) % 7);
    input.reading.fresh = true;
    input.force = Vec3(0, 1 + input.reading.position.x, 0);
    benchmark::DoNotOptimize(filter_force(limits, input, safety));
  }
}
BENCHMARK(safety_filter);

void damping_of_ringing(benchmark::State& state) {
  EnergyState energy;
  Reading reading;
  for (auto _ : state) {
    reading.time += 1e-3;
    reading.position.x = 1e-5 * static_cast<double>(static_cast<int>(reading.time * 1e3) % 7);
    reading.fresh = true;
    benchmark::DoNotOptimize(damp_ringing({}, reading, Vec3(0, 1, 0), energy));
  }
}
BENCHMARK(damping_of_ringing);

void simulated_tick(benchmark::State& state) {
  SimulatedStylus stylus;
  stylus.open();
  for (auto _ : state) {
    benchmark::DoNotOptimize(stylus.read());
    stylus.write_force(Vec3(0, 0.5, 0));
  }
}
BENCHMARK(simulated_tick);

void falcon_forward(benchmark::State& state) {
  const FalconGeometry geometry;
  const Vec3 there(0.01, -0.02, 0.13);
  const Vec3 angles = *falcon_angles(geometry, there);
  // From as far as a hand of 500 mm/s gets in a tick.
  const Vec3 start = there + Vec3(0.0005, 0, 0);
  for (auto _ : state) benchmark::DoNotOptimize(falcon_position(geometry, angles, start));
}
BENCHMARK(falcon_forward);

void falcon_force_to_motors(benchmark::State& state) {
  const FalconGeometry geometry;
  for (auto _ : state) {
    const auto torques = falcon_torques(geometry, {0.01, -0.02, 0.13}, {1, 2, -1});
    benchmark::DoNotOptimize(falcon_motors(*torques, 10000));
  }
}
BENCHMARK(falcon_force_to_motors);

void falcon_command_encoded(benchmark::State& state) {
  FalconCommand command{.motors = {100, -2000, 4096}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(command.motors);
    benchmark::DoNotOptimize(encode(command));
  }
}
BENCHMARK(falcon_command_encoded);

void falcon_reply_decoded(benchmark::State& state) {
  // A command is coded as a reply is.
  const auto packet = encode({.motors = {100, -2000, 4096}});
  FalconReplies replies;
  for (auto _ : state) benchmark::DoNotOptimize(replies.feed(packet));
}
BENCHMARK(falcon_reply_decoded);

void wooden_haptics_forward(benchmark::State& state) {
  const WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  std::array<int, 3> counts{1000, 2000, -500};
  for (auto _ : state) {
    benchmark::DoNotOptimize(counts);
    benchmark::DoNotOptimize(wooden_haptics_position(settings, wooden_haptics_angles(settings, counts)));
  }
}
BENCHMARK(wooden_haptics_forward);

void wooden_haptics_force_to_currents(benchmark::State& state) {
  const WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        wooden_haptics_currents(settings, wooden_haptics_torques(settings, {0.1, 0.5, 0.4}, {1, 2, -1})));
  }
}
BENCHMARK(wooden_haptics_force_to_currents);

}  // namespace
}  // namespace palpate::device
