/// The time that a change of the scene takes on the panel's thread, with a scan of 512 x 512 x 400 voxels.
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>

#include "modes/scene/scene_json.h"
#include "plugin/app/live_session.h"
#include "testdata/scan_shapes.h"

namespace palpate::plugin {
namespace {

void change(benchmark::State& state, const std::function<void(modes::Scene&, double)>& edit) {
  static const std::shared_ptr<const io::Volume> volume = testdata::plain_chest({512, 512, 400});
  LiveSession live;
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  live.set_scan(volume, scene);
  double part = 0;
  while (state.KeepRunning()) {
    part = part < 1 ? part + 0.01 : 0;
    edit(scene, part);
    live.set_scene(scene, Pace::dragged);
  }
}

void dragged_node(benchmark::State& state) {
  change(state, [](modes::Scene& scene, double part) {
    scene.modes[0].strength_n = modes::TransferFunction({{20, 0}, {90, 0.5 + part}});
  });
}
BENCHMARK(dragged_node)->Unit(benchmark::kMillisecond);

void dragged_node_of_32_modes(benchmark::State& state) {
  change(state, [](modes::Scene& scene, double part) {
    while (scene.modes.size() < modes::Scene::most_modes) {
      scene.modes.push_back(scene.modes[0]);
      scene.modes.back().name.append(std::to_string(scene.modes.size()));
    }
    scene.modes[0].strength_n = modes::TransferFunction({{20, 0}, {90, 0.5 + part}});
  });
}
BENCHMARK(dragged_node_of_32_modes)->Unit(benchmark::kMillisecond);

void other_scale_of_gradients(benchmark::State& state) {
  change(state, [](modes::Scene& scene, double part) { scene.gradient_scale_mm = 1 + part; });
}
BENCHMARK(other_scale_of_gradients)->Unit(benchmark::kMillisecond);

void other_reach(benchmark::State& state) {
  change(state, [](modes::Scene& scene, double part) {
    scene.workspace.fit = false;
    scene.workspace.scale = 0.3 + part;
  });
}
BENCHMARK(other_reach)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace palpate::plugin
