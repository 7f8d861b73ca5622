#include "plugin/bench/bench_waits.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "io/fields/gradient.h"
#include "io/fresh_folder.h"
#include "io/quantile.h"
#include "modes/scene/felt_strength.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/suggest.h"
#include "plugin/app/open_scan.h"
#include "plugin/bench/csv_table.h"
#include "plugin/options/series_option.h"
#include "plugin/report/chart.h"
#include "plugin/session/prepared_scene.h"
#include "solver/exact.h"
#include "solver/testing/problems.h"
#include "testdata/scan.h"
#include "testdata/scan_shapes.h"

namespace palpate::plugin {
namespace {

struct WaitsArguments {
  SeriesOption series;
  std::string output;
  int rounds = 3;
  int largest = 512;
  bool shapes = false;
  int slices = 248;
};

/// MiB, from the kernel's account of this process: "VmRSS" or "VmHWM".
double memory_mib(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name + ":")) return std::stod(line.substr(name.size() + 1)) / 1024;
  }
  return 0;
}

struct Cost {
  double seconds = 0;   ///< the best of some rounds: what else the machine did is not the work's
  double peak_mib = 0;  ///< beyond what was there before
};

Cost cost_of(int rounds, const std::function<void()>& work) {
  Cost cost{.seconds = 1e300};
  const double before = memory_mib("VmRSS");
  std::ofstream("/proc/self/clear_refs") << "5";  // forgets the most so far
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    work();
    cost.seconds =
        std::min(cost.seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  cost.peak_mib = std::max(0.0, memory_mib("VmHWM") - before);
  return cost;
}

/// N at every voxel, as the plug-in's filter computes it.
std::vector<float> felt_everywhere(const std::shared_ptr<const io::Volume>& volume, const modes::Scene& scene) {
  const auto plan = plan_for(scene, *volume, glm::dvec3(0.1));
  const auto holding = modes::holding_modes(*plan);
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  const modes::FeltStrength strength(*volume, holding, scene.sampling.value, scale_mm);
  std::vector<float> felt(volume->offset(0, 0, volume->geometry.dimensions.z));
  const io::GradientKernel kernel(volume, scale_mm);
  kernel.for_each_block([&](const io::Block& block, std::span<const glm::vec3> gradients) {
    const auto count = static_cast<std::size_t>(block.size.x);
    const glm::ivec3 end = block.first + block.size;
    for (int k = block.first.z; k < end.z; ++k) {
      for (int j = block.first.y; j < end.y; ++j, gradients = gradients.subspan(count)) {
        const glm::ivec3 first(block.first.x, j, k);
        strength.at_row(first, gradients.first(count),
                        std::span(felt).subspan(volume->offset(first.x, first.y, first.z), count));
      }
    }
  });
  return felt;
}

std::shared_ptr<const io::Volume> ball_of(int size) {
  testdata::Phantom ball = testdata::make_sphere(0.4 * size);
  ball.bodies.push_back(testdata::make_sphere(0.2 * size, testdata::bone_hu).bodies.front());
  return std::make_shared<const io::Volume>(
      testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(size)}), {.noise = 20}));
}

struct Growth {
  Chart chart;

  Growth(std::string title, std::string x, std::string y, const std::vector<std::string>& names)
      : chart{.title = std::move(title),
              .x = {.label = std::move(x), .logarithmic = true},
              .y = {.label = std::move(y), .logarithmic = true},
              .curves = {},
              .marks = {}} {
    constexpr Color palette[] = {colors::black, colors::sky, colors::vermilion, colors::green};
    for (std::size_t n = 0; n < names.size(); ++n) chart.curves.push_back({.label = names[n], .color = palette[n]});
  }
  void add(std::size_t curve, double x, double y) {
    chart.curves[curve].x.push_back(x);
    chart.curves[curve].y.push_back(y);
  }
};

const std::vector<std::string> of_voxels{"gradient", "suggest", "felt", "felt (suggested)"};

void tabulate_scan(const std::string& name, const std::shared_ptr<const io::Volume>& volume, int rounds,
                   CsvTable& table, Growth& growth) {
  const auto voxels = static_cast<double>(volume->offset(0, 0, volume->geometry.dimensions.z));
  const io::GradientKernel kernel(volume, io::default_gradient_scale_mm(volume->geometry));
  const modes::Scene scene = scene_for("", *volume);
  const modes::Scene suggested = modes::suggest(volume).scene;
  const std::vector<std::function<void()>> works{
      [&] { kernel.for_each_block([](const io::Block&, std::span<const glm::vec3>) {}); },
      [&] { (void)modes::suggest(volume); }, [&] { (void)felt_everywhere(volume, scene); },
      [&] { (void)felt_everywhere(volume, suggested); }};
  for (std::size_t n = 0; n < works.size(); ++n) {
    const Cost cost = cost_of(rounds, works[n]);
    table.add(fmt::format("{},{},{:.0f},{:.3f},{:.1f},{:.0f}", of_voxels[n], name, voxels, cost.seconds,
                          1e9 * cost.seconds * std::thread::hardware_concurrency() / voxels, cost.peak_mib));
    growth.add(n, voxels / 1e6, cost.seconds);
  }
}

/// The starting scene for CT with one boundary after the other, from -800 HU on.
modes::Scene scene_of_modes(int count) {
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const modes::Mode skin = scene.modes.front();
  scene.modes.clear();
  for (int n = 0; n < count; ++n) {
    modes::Mode mode = skin;
    const double from = -800 + 100.0 * n;
    mode.name += " " + std::to_string(n);
    mode.gates = {{modes::Datum::value, modes::TransferFunction({{from, 0}, {from + 20, 1}})}};
    scene.modes.push_back(std::move(mode));
  }
  return scene;
}

void tabulate_modes(int size, int rounds, CsvTable& table, Growth& growth) {
  const auto volume = ball_of(size);
  const auto voxels = static_cast<double>(volume->offset(0, 0, size));
  for (const int count : {1, 2, 4, 8, 16}) {
    const modes::Scene scene = scene_of_modes(count);
    const Cost cost = cost_of(rounds, [&] { (void)felt_everywhere(volume, scene); });
    table.add(fmt::format("felt,{} modes,{:.0f},{:.3f},{:.1f},{:.0f}", count, voxels, cost.seconds,
                          1e9 * cost.seconds * std::thread::hardware_concurrency() / voxels, cost.peak_mib));
    growth.add(0, count, cost.seconds);
  }
}

struct SolverTimes {
  double median_us = 0, largest_us = 0, memory_kib = 0;
};

/// 40 balances of `count` primitives, cold; the fastest of five runs of each counts.
SolverTimes solver_times(std::size_t count) {
  std::vector<double> times;
  solver::ExactScratch scratch(count);
  std::vector<solver::Vec3> forces(count);
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const solver::Problem problem = make_problem(solver::Family::many, seed, count);
    const Cost cost = cost_of(5, [&] { (void)solve_exact(problem.balance(), forces, scratch); });
    times.push_back(1e6 * cost.seconds);
  }
  return {io::quantile(times, 0.5), io::quantile(times, 1), static_cast<double>(scratch.memory_bytes()) / 1024};
}

void tabulate_primitives(const std::filesystem::path& folder, Growth& growth) {
  CsvTable table("exact solve: primitives,p50_us,largest_us,memory_kib");
  for (const std::size_t count : {1U, 2U, 5U, 10U, 20U, 50U, 100U, 200U, 500U, 1000U}) {
    const SolverTimes times = solver_times(count);
    table.add(fmt::format("{},{:.2f},{:.2f},{:.1f}", count, times.median_us, times.largest_us, times.memory_kib));
    growth.add(0, static_cast<double>(count), times.median_us);
    growth.add(1, static_cast<double>(count), times.largest_us);
  }
  table.save(folder, "primitives.csv");
}

/// Announces the next step if stderr is a terminal; the following row overwrites it.
void say_next(const std::string& what) {
  if (::isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "%s ...\033[K\r", what.c_str());
}

/// Each shape of scan beside the plain one, in turn, on one thread.
void tabulate_shapes(int slices, int rounds, const std::filesystem::path& folder) {
  struct Work {
    const char* name;
    std::function<void(const std::shared_ptr<const io::Volume>&)> once;
  };
  const auto pass_over = [](const io::GradientKernel& kernel) {
    kernel.for_each_block([](const io::Block&, std::span<const glm::vec3>) {}, {}, 1);
  };
  const std::vector<Work> works{{"gradient",
                                 [&](const auto& v) {
                                   pass_over({v, io::default_gradient_scale_mm(v->geometry)});
                                 }},
                                {"central differences",
                                 [&](const auto& v) {
                                   pass_over({v, io::GradientKernel::CentralDifferences{}});
                                 }},
                                {"suggest", [](const auto& v) { (void)modes::suggest(v, {}, 1); }}};
  say_next("making the plain scan");
  const std::shared_ptr<const io::Volume> plain = testdata::plain_chest({512, 512, slices});
  CsvTable table("work,shape,plain_s,shape_s,ratio,peak_mib");
  for (const testdata::ScanShape& shape : testdata::scan_shapes()) {
    say_next("making: " + shape.name);
    const std::shared_ptr<const io::Volume> volume = shape.from(*plain);
    for (const Work& work : works) {
      say_next(fmt::format("{}: {}", work.name, shape.name));
      double peak_mib = 0;
      const testdata::CostRatio cost = testdata::compare_costs(
          rounds, [&] { work.once(plain); }, [&] { peak_mib = cost_of(1, [&] { work.once(volume); }).peak_mib; });
      table.add(fmt::format("{},{},{:.3f},{:.3f},{:.2f},{:.0f}", work.name, shape.name, cost.plain_s, cost.shape_s,
                            cost.ratio(), peak_mib));
    }
  }
  table.save(folder, "shapes.csv");
}

void run(const WaitsArguments& arguments, const std::filesystem::path& folder) {
  fmt::print("On {} cores; seconds: best of {}; peak memory: beyond the scan's own.\n",
             std::thread::hardware_concurrency(), arguments.rounds);
  std::fflush(stdout);
  Growth sizes("Against size", "voxels (millions)", "seconds", of_voxels);
  Growth modes("Felt strength against modes", "modes", "seconds", {""});
  Growth primitives("Exact solve against primitives", "primitives", "us", {"median of 40", "largest"});
  if (arguments.shapes) {
    tabulate_shapes(arguments.slices, arguments.rounds, folder);
    return;
  }
  CsvTable table("work,scan,voxels,seconds,ns_a_voxel_and_core,peak_mib");
  if (!arguments.series.path.empty()) {
    const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
    std::string name = describe_scan(*volume);
    std::ranges::replace(name, ',', ';');
    tabulate_scan(name, volume, arguments.rounds, table, sizes);
    table.save(folder, "waits.csv");
    return;
  }
  for (int size = 128; size <= arguments.largest; size *= 2) {
    tabulate_scan(fmt::format("ball of {} voxels cubed", size), ball_of(size), arguments.rounds, table, sizes);
  }
  tabulate_modes(std::min(256, arguments.largest), arguments.rounds, table, modes);
  table.save(folder, "waits.csv");
  tabulate_primitives(folder, primitives);
  if (folder.empty()) return;
  write_png(std::vector{sizes.chart, modes.chart, primitives.chart}, folder / "growth.png");
}

}  // namespace

void add_bench_waits(CLI::App& bench) {
  CLI::App* command = bench.add_subcommand(
      "waits",
      "What people wait for: suggestions and felt strength, and how they grow with the size of a scan, the "
      "number of modes and of primitives");
  const auto arguments = std::make_shared<WaitsArguments>();
  add_series_option(*command, arguments->series);
  command->get_option("SERIES")->required(false);
  command->add_option("--rounds", arguments->rounds, "runs of each")->capture_default_str()->check(CLI::PositiveNumber);
  command->add_option("--largest", arguments->largest, "voxels along an edge of the largest ball")
      ->capture_default_str()
      ->check(CLI::Range(64, 1024));
  command->add_flag(
      "--shapes", arguments->shapes,
      "time a CT of 512 x 512 in each form that scanners send (padding, tilt, floats and so on) and in the plain form");
  command->add_option("--slices", arguments->slices, "with --shapes: how many slices the CT has")
      ->capture_default_str()
      ->check(CLI::Range(16, 1000));
  command->add_option("-o,--output", arguments->output, "also write CSV and a picture to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) { run(*arguments, folder); });
  });
}

}  // namespace palpate::plugin
