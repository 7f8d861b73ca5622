// One tick of the modes and the solver, without a device: the scene of surface + friction, the wind tunnel's three
// modes, and what a tick costs with the number of modes. Sources are analytic: what a scan's sampling costs is io's
// benchmark.
#include <benchmark/benchmark.h>

#include <cmath>

#include "modes/scene/scene_json.h"
#include "modes/testing/test_rig.h"
#include "testdata/analytic.h"
#include "testdata/flow.h"

namespace palpate::modes {
namespace {

/// Back and forth through the skin of a sphere of 25 mm, 50 mm/s.
void step_through(benchmark::State& state, const Scene& scene, const io::FieldSource& source) {
  testing::Hand hand(scene, source);
  double t = 0;
  while (state.KeepRunning()) {
    t += 0.05;
    hand.move_to({3 * std::sin(0.02 * t), 0, 25 + 2 * std::sin(0.4 * t)});
    benchmark::DoNotOptimize(hand.result.force_n);
  }
}

void surface_and_friction(benchmark::State& state) {
  Scene scene = load_scene("ct-skin-and-bone");
  scene.subdivision.most = 1;
  step_through(state, scene, testdata::AnalyticSource(testdata::make_sphere(25), 1.0));
}
BENCHMARK(surface_and_friction);

void wind_tunnel_three_modes(benchmark::State& state) {
  Scene scene = load_scene("flow");
  scene.subdivision.most = 1;
  scene.modes.push_back(testing::surface(TransferFunction({{0, 0}, {0.05, 0.8}})));
  step_through(state, scene, testdata::FlowSource({}));
}
BENCHMARK(wind_tunnel_three_modes);

void surfaces(benchmark::State& state) {
  Scene scene = testing::scene_of({});
  for (int i = 0; i < state.range(0); ++i) {
    scene.modes.push_back(testing::surface(TransferFunction({{0, 0}, {60, 0.3}})));
  }
  step_through(state, scene, testdata::AnalyticSource(testdata::make_sphere(25), 1.0));
}
BENCHMARK(surfaces)->RangeMultiplier(2)->Range(1, 8);

void sampling_alone(benchmark::State& state) {
  const testdata::AnalyticSource source(testdata::make_sphere(25), 1.0);
  double t = 0;
  while (state.KeepRunning()) {
    t += 0.05;
    benchmark::DoNotOptimize(source.sample({3 * std::sin(0.02 * t), 0, 25 + 2 * std::sin(0.4 * t)},
                                           io::FieldSet::value | io::FieldSet::gradient));
  }
}
BENCHMARK(sampling_alone);

}  // namespace
}  // namespace palpate::modes
