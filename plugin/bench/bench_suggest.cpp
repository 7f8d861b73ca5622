#include "plugin/bench/bench_suggest.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "io/fields/gradient.h"
#include "io/quantile.h"
#include "modes/scene/suggest.h"
#include "plugin/app/open_scan.h"
#include "plugin/bench/ray_study.h"
#include "plugin/options/series_option.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

struct SuggestArguments {
  SeriesOption series;
  bool rays = false;
  int rounds = 5;
  int largest = 512;
};

struct Work {
  const char* name;
  std::function<void(int threads)> once;
};

/// Seconds in the median of some rounds; the works take turns, so that other load on the machine meets all of them.
std::vector<double> seconds_of(const std::vector<Work>& works, int threads, int rounds) {
  std::vector<std::vector<double>> runs(works.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t n = 0; n < works.size(); ++n) {
      const auto began = std::chrono::steady_clock::now();
      works[n].once(threads);
      runs[n].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    }
  }
  std::vector<double> medians;
  medians.reserve(runs.size());
  for (const auto& run : runs) medians.push_back(io::quantile(run, 0.5));
  return medians;
}

void print_row(const std::string& name, const std::shared_ptr<const io::Volume>& volume, int rounds) {
  const io::GradientKernel kernel(volume, io::default_gradient_scale_mm(volume->geometry));
  const std::vector<Work> works{
      {"voxels", [&](int) { (void)io::statistics(*volume); }},
      {"gradient",
       [&](int threads) { kernel.for_each_block([](const io::Block&, std::span<const glm::vec3>) {}, {}, threads); }},
      {"suggest", [&](int threads) { (void)modes::suggest(volume, {}, threads); }}};
  const auto all = static_cast<int>(std::thread::hardware_concurrency());
  const auto one_core = seconds_of(works, 1, rounds);
  const auto all_cores = seconds_of(works, all, rounds);
  fmt::print("{:<36} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>7.2f}\n", name, all_cores[0], one_core[1],
             all_cores[1], one_core[2], all_cores[2], all_cores[2] / all_cores[1]);
}

void run(const SuggestArguments& arguments) {
  if (arguments.rays) {
    const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
    run_ray_study(describe_scan(*volume), volume);
    return;
  }
  fmt::print("seconds, median of {} rounds; {} cores\n", arguments.rounds, std::thread::hardware_concurrency());
  fmt::print("{:<36} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "scan", "read", "gradient", "all cores", "suggest",
             "all cores", "ratio");
  if (!arguments.series.path.empty()) {
    const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
    print_row(describe_scan(*volume), volume, arguments.rounds);
    return;
  }
  for (int size = 64; size <= arguments.largest; size *= 2) {
    testdata::Phantom ball = testdata::make_sphere(0.4 * size);
    ball.bodies.push_back(testdata::make_sphere(0.2 * size, testdata::bone_hu).bodies.front());
    const auto volume = std::make_shared<const io::Volume>(
        testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(size)}), {.noise = 20}));
    print_row(fmt::format("ball, {} voxels cubed", size), volume, arguments.rounds);
  }
}

}  // namespace

void add_bench_suggest(CLI::App& bench) {
  CLI::App* command =
      bench.add_subcommand("suggest", "The time to find a scan's tissues, compared with one pass of the gradient");
  const auto arguments = std::make_shared<SuggestArguments>();
  add_series_option(*command, arguments->series);
  command->get_option("SERIES")->required(false);
  command
      ->add_flag("--rays", arguments->rays,
                 "measure how much bone is felt with the proposed scene on 20 rays into the scan")
      ->needs(command->get_option("SERIES"));
  command->add_option("--rounds", arguments->rounds, "runs of each, in turn")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--largest", arguments->largest, "voxels along an edge of the largest ball")
      ->capture_default_str()
      ->check(CLI::Range(64, 1024));
  command->callback([arguments] { run(*arguments); });
}

}  // namespace palpate::plugin
