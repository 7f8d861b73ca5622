// Run times of the fields of a scan: a sample hot, cold and without its brick, bricks, whole volumes, and loading.
#include <benchmark/benchmark.h>

#include <array>
#include <filesystem>
#include <random>

#include "io/fields/volume_fields.h"
#include "io/load.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

constexpr FieldSet both = FieldSet::value | FieldSet::gradient;

const std::shared_ptr<const Volume>& noise() {
  static const std::shared_ptr<const Volume> volume = [] {
    testdata::Grid grid;
    grid.size = {256, 256, 128};
    grid.spacing = {0.7, 0.7, 1};
    Volume v;
    v.geometry = testdata::make_geometry(grid);
    std::vector<std::int16_t> voxels(v.offset(0, 0, grid.size.z));
    std::minstd_rand random(1);
    for (std::int16_t& voxel : voxels) voxel = static_cast<std::int16_t>(random() % 2000);
    v.voxels = std::move(voxels);
    return std::make_shared<const Volume>(std::move(v));
  }();
  return volume;
}

void sample(benchmark::State& state, FieldSet wanted, GradientMethod method, bool bricks, double reach) {
  const VolumeFields fields(
      noise(), wanted, 1.5,
      {.gradient = method, .brick_bytes = bricks ? std::size_t{64} << 20 : 0, .background = false});
  fields.prepare(Vec3(0), 2 * reach);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-reach, reach);
  std::array<Vec3, 1024> points;
  for (Vec3& p : points) p = {anywhere(random), anywhere(random), anywhere(random)};
  std::size_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(fields.sample(points[n++ % points.size()], wanted));
}
constexpr auto gaussian = GradientMethod::gaussian;
BENCHMARK_CAPTURE(sample, value, FieldSet::value, gaussian, false, 5.0);
BENCHMARK_CAPTURE(sample, gradient_hot, both, gaussian, true, 5.0);
BENCHMARK_CAPTURE(sample, gradient_cold, both, gaussian, true, 30.0);
BENCHMARK_CAPTURE(sample, gradient_missing, both, gaussian, false, 5.0);
BENCHMARK_CAPTURE(sample, central_missing, both, GradientMethod::central_differences, false, 5.0);
BENCHMARK_CAPTURE(sample, b_spline, both, GradientMethod::cubic, false, 5.0);
BENCHMARK_CAPTURE(sample, low_high_hot, FieldSet::low_high, gaussian, true, 5.0);
BENCHMARK_CAPTURE(sample, tube_hot, FieldSet::tube, gaussian, true, 5.0);
BENCHMARK_CAPTURE(sample, tube_missing, FieldSet::tube, gaussian, false, 5.0);

void brick(benchmark::State& state, bool hessians) {
  const GradientKernel kernel(noise(), 1.5);
  const Block block{{100, 100, 50}, glm::ivec3(17)};
  std::vector<glm::vec3> gradients(block.voxels());
  std::vector<GradientKernel::Hessian> second(block.voxels());
  for (auto _ : state) {
    hessians ? kernel.hessians_at_block(block, second) : kernel.at_block(block, gradients);
    benchmark::ClobberMemory();
  }
}
BENCHMARK_CAPTURE(brick, gradients, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(brick, hessians, true)->Unit(benchmark::kMicrosecond);

void whole_volume(benchmark::State& state, bool central) {
  const GradientKernel kernel =
      central ? GradientKernel(noise(), GradientKernel::CentralDifferences{}) : GradientKernel(noise(), 1.5);
  std::vector<glm::vec3> gradients(noise()->offset(0, 0, noise()->geometry.dimensions.z));
  for (auto _ : state) kernel.whole_into(gradients, {}, 1);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(gradients.size()));
}
BENCHMARK_CAPTURE(whole_volume, gaussian, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_volume, central, true)->Unit(benchmark::kMillisecond);

void load_series(benchmark::State& state, const char* name) {
  const std::filesystem::path folder = std::filesystem::path(PALPATE_SHARED_DATA) / name;
  if (!std::filesystem::exists(folder)) {
    state.SkipWithError("the series is not here");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(load(find_series(std::array{folder}).series.at(0)));
}
BENCHMARK_CAPTURE(load_series, ct_head_phantom_140, "ct_head_phantom_140")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(load_series, mr_t1_ax_384, "mr_t1_ax_384")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace palpate::io
