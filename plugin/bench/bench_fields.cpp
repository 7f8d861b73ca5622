#include "plugin/bench/bench_fields.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <memory>
#include <new>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "io/fields/volume_fields.h"
#include "io/fresh_folder.h"
#include "plugin/bench/csv_table.h"
#include "plugin/bench/field_errors.h"
#include "plugin/bench/filter_study.h"
#include "plugin/options/series_option.h"
#include "plugin/report/text_file.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using Clock = std::chrono::steady_clock;
using io::Vec3;
constexpr io::FieldSet value_and_gradient = io::FieldSet::value | io::FieldSet::gradient;

struct FieldsArguments {
  SeriesOption series;
  std::string output;
  bool filters = false;
  bool quick = false;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Time of one call, microseconds: the best of several runs.
double microseconds(int calls, const std::function<void(int)>& call) {
  double best = 1e300;
  for (int run = 0; run < 5; ++run) {
    const auto start = Clock::now();
    for (int n = 0; n < calls; ++n) call(n);
    best = std::min(best, 1e6 * seconds_since(start) / calls);
  }
  return best;
}

std::shared_ptr<const io::Volume> large_volume(bool quick) {
  testdata::Grid grid;
  grid.size = quick ? glm::ivec3(256, 256, 124) : glm::ivec3(512, 512, 248);
  grid.spacing = {0.7, 0.7, 1};
  io::Volume volume;
  volume.geometry = testdata::make_geometry(grid);
  std::vector<std::int16_t> voxels(volume.offset(0, 0, grid.size.z));
  std::minstd_rand random(1);
  for (std::int16_t& v : voxels) v = static_cast<std::int16_t>(random() % 2000);
  volume.voxels = std::move(voxels);
  return std::make_shared<const io::Volume>(std::move(volume));
}

/// Best of three, each into fresh memory, as the kernel gives it unless large pages are requested.
double best_seconds(std::size_t count, const std::function<void(std::span<glm::vec3>)>& write) {
  struct Free {
    void operator()(void* memory) const { std::free(memory); }  // NOLINT: of aligned_alloc
  };
  constexpr std::size_t large = std::size_t{2} << 20;
  double best = 1e300;
  for (int run = 0; run < 3; ++run) {
    const std::unique_ptr<void, Free> memory(
        std::aligned_alloc(large, (count * sizeof(glm::vec3) + large - 1) / large * large));
    if (!memory) throw std::bad_alloc();
    const auto start = Clock::now();
    write({static_cast<glm::vec3*>(memory.get()), count});
    best = std::min(best, seconds_since(start));
  }
  return best;
}

/// Seconds that a program beside this one prints; nothing where it was not built.
std::optional<double> peer_seconds(const char* name, const glm::ivec3& size) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
  if (!std::filesystem::exists(program)) return std::nullopt;
  const std::string call = fmt::format("{} {} {} {} 3", program.string(), size.x, size.y, size.z);
  FILE* const pipe = ::popen(call.c_str(), "r");  // NOLINT: a program of this build
  if (pipe == nullptr) return std::nullopt;
  double seconds = 0;
  const int got = std::fscanf(pipe, "%lf", &seconds);  // NOLINT: its only output
  return ::pclose(pipe) == 0 && got == 1 ? std::optional(seconds) : std::nullopt;
}

void tabulate_whole_volumes(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder) {
  const glm::ivec3 size = volume->geometry.dimensions;
  const std::size_t count = volume->offset(0, 0, size.z);
  const io::GradientKernel gaussian(volume, io::default_gradient_scale_mm(volume->geometry));
  const io::GradientKernel central(volume, io::GradientKernel::CentralDifferences{});
  CsvTable table("whole volume,threads,pages,seconds");
  // In the pages that the gradients ask for, too: the harder yardstick.
  const auto cold_write = [&](bool large) {
    return best_seconds(count, [&](std::span<glm::vec3> to) {
      if (large) ::madvise(to.data(), to.size_bytes(), MADV_HUGEPAGE);
      std::memset(static_cast<void*>(to.data()), 1, to.size_bytes());
    });
  };
  const double cold_small = cold_write(false);
  const double cold = cold_write(true);
  table.add(fmt::format("cold write of the output,1,as they come,{:.3f}", cold_small));
  table.add(fmt::format("cold write of the output,1,large,{:.3f}", cold));
  double ours = 0;
  for (const int threads : {1, 0}) {
    const char* const how = threads == 1 ? "1" : "all";
    const auto take = [&](const io::GradientKernel& kernel) {
      return best_seconds(count, [&](std::span<glm::vec3> to) { kernel.whole_into(to, {}, threads); });
    };
    const double filtered = take(gaussian);
    ours = take(central);
    table.add(fmt::format("central differences,{},large,{:.3f}", how, ours));
    table.add(fmt::format("gaussian of {:.2g} mm,{},large,{:.3f}", gaussian.scale_mm(), how, filtered));
    fmt::print("# central / cold write {:.2f} (pages as they come {:.2f}), gaussian / central {:.2f}\n", ours / cold,
               ours / cold_small, filtered / ours);
  }
  for (const auto& [name, program] :
       {std::pair{"vtkImageGradient", "gradient_by_vtk"}, std::pair{"ITK recursive gaussian", "gradient_by_itk"}}) {
    if (const auto seconds = peer_seconds(program, size)) {
      table.add(fmt::format("{},all,as they come,{:.3f}", name, *seconds));
      fmt::print("# central / {} {:.2f}\n", name, ours / *seconds);
    } else {
      fmt::print("# {}: {} is not beside this program (-DPALPATE_PEERS=ON builds it where it can)\n", name, program);
    }
  }
  table.save(folder, "whole_volume_times.csv");
}

void tabulate_samples(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder) {
  const double scale = io::default_gradient_scale_mm(volume->geometry);
  const io::GradientKernel kernel(volume, scale);
  CsvTable table("sample,microseconds");
  std::vector<glm::vec3> brick(std::size_t{17} * 17 * 17);
  const glm::ivec3 middle = volume->geometry.dimensions / 3;
  const double fill = microseconds(50, [&](int n) { kernel.at_block({middle + n, glm::ivec3(17)}, brick); });
  table.add(fmt::format("filling a brick of 16x16x16 cells,{:.0f}", fill));
  double sum = 0;  // so that no sample is optimised away
  const auto near = [](int n) { return Vec3(n % 97, n % 89, n % 83) * 0.1; };
  const auto far = [](int n) { return Vec3((n * 37) % 40 - 20, (n * 23) % 40 - 20, (n * 29) % 40 - 20); };
  const auto time_of = [&](const io::VolumeFields& fields, io::FieldSet wanted, int calls, bool scattered) {
    return microseconds(calls, [&](int n) {
      const io::Sample s = fields.sample(scattered ? far(n) : near(n), wanted);
      sum += s.value + s.gradient.x + s.low + s.tube.x;
    });
  };
  struct Row {
    const char* name;
    io::FieldSet wanted;
    io::GradientMethod method = io::GradientMethod::gaussian;
  };
  for (const auto& [name, wanted, method] :
       {Row{"value", io::FieldSet::value}, Row{"value and gradient", value_and_gradient},
        Row{"value; central differences", value_and_gradient, io::GradientMethod::central_differences},
        Row{"value and gradient by b-spline", value_and_gradient, io::GradientMethod::cubic},
        Row{"low and high", io::FieldSet::low_high}, Row{"tube", io::FieldSet::tube}}) {
    const io::VolumeFields hot(volume, wanted, scale, {.gradient = method, .background = false});
    hot.prepare(Vec3(0), 20);
    const io::VolumeFields without(volume, wanted, scale, {.gradient = method, .brick_bytes = 0, .background = false});
    table.add(fmt::format("{}: hot,{:.3f}", name, time_of(hot, wanted, 5000, false)));
    table.add(fmt::format("{}: cold,{:.3f}", name, time_of(hot, wanted, 5000, true)));
    table.add(fmt::format("{}: brick missing,{:.3f}", name, time_of(without, wanted, 500, false)));
  }
  if (!std::isfinite(sum)) fmt::print("{}\n", sum);
  table.save(folder, "sample_times.csv");
}

/// A stylus at 1 kHz on a winding way: how many samples find no brick.
void tabulate_misses(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder) {
  constexpr double seconds = 5;
  const double scale = io::default_gradient_scale_mm(volume->geometry);
  CsvTable table("speed_mm_per_s,samples,missing_percent,memory_mib");
  for (const double speed : {50.0, 200.0, 500.0}) {
    const io::VolumeFields fields(volume, value_and_gradient, scale);
    const double radius = 40;
    int missing = 0;
    const int ticks = static_cast<int>(1000 * seconds);
    auto next = Clock::now();
    for (int n = 0; n < ticks; ++n) {
      const double way = speed * n / 1000.0;
      const double angle = way / radius;
      // A great circle that turns: never the same way twice in the five seconds.
      const Vec3 p = radius * Vec3(std::cos(angle), std::sin(angle) * std::cos(0.3 * angle),
                                   std::sin(angle) * std::sin(0.3 * angle));
      missing += !fields.sample(p, value_and_gradient).from_brick;
      next += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(next);
    }
    table.add(fmt::format("{:.0f},{},{:.2f},{:.1f}", speed, ticks, 100.0 * missing / ticks,
                          static_cast<double>(fields.memory_bytes()) / 1048576));
  }
  table.save(folder, "brick_misses.csv");
}

void run_all(const FieldsArguments& arguments, const std::filesystem::path& folder) {
  if (arguments.filters) {
    const std::string csv = run_filter_study();
    if (!folder.empty()) write_text(folder / "filters.csv", csv);
    return;
  }
  tabulate_gradient_errors(folder);
  const auto volume = large_volume(arguments.quick);
  tabulate_whole_volumes(volume, folder);
  tabulate_samples(volume, folder);
  tabulate_misses(volume, folder);
  if (!arguments.series.path.empty()) {
    tabulate_direction_jitter(std::make_shared<const io::Volume>(load_series(arguments.series)), folder);
  }
}

}  // namespace

void add_bench_fields(CLI::App& bench) {
  auto arguments = std::make_shared<FieldsArguments>();
  CLI::App* command =
      bench.add_subcommand("fields", "Gradients: errors on phantoms, run times, and bricks ahead of a stylus");
  command->add_option("SERIES", arguments->series.path,
                      "A scan on which the jitter of the gradient's direction at rest is also measured");
  command->add_option("--series", arguments->series.series, "Which series, by number or UID");
  command->add_option("-o,--output", arguments->output, "Also write CSV to this new or empty folder");
  command->add_flag("--filters", arguments->filters,
                    "Measure the effect of each filter on roughness and on boundaries");
  command->add_flag("--quick", arguments->quick, "Measure times on an eighth of the volume");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) { run_all(*arguments, folder); });
  });
}

}  // namespace palpate::plugin
