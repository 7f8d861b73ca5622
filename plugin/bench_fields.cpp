#include "palpate/plugin/bench_fields.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "palpate/io/volume_fields.h"
#include "palpate/plugin/series_option.h"
#include "palpate/testdata/fresh_folder.h"
#include "palpate/testdata/scan.h"

namespace palpate::plugin {
namespace {

using Clock = std::chrono::steady_clock;
using io::Vec3;
constexpr io::FieldSet both = io::FieldSet::value | io::FieldSet::gradient;

struct FieldsArguments {
  SeriesOption series;
  std::string output;
  bool quick = false;
};

/// Lines of a table on stdout, kept for the CSV.
class Table {
 public:
  explicit Table(std::string header) : csv_(std::move(header) + "\n") { fmt::print("\n{}", csv_); }
  void add(const std::string& row) {
    fmt::print("{}\n", row);
    csv_ += row + "\n";
  }
  void save(const std::filesystem::path& folder, const std::string& name) const {
    if (folder.empty()) return;
    std::ofstream file(folder / name);
    file << csv_;
    if (!file.flush()) throw std::runtime_error((folder / name).string() + ": cannot be written");
  }

 private:
  std::string csv_;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Slope of a ball of 1040 HU blurred by a Gaussian, at its surface.
double slope_at_surface(double radius, double scale) {
  const double z = radius / scale;
  const double density = 1040 / (scale * std::sqrt(2 * std::acos(-1.0)));
  return density * (1 + std::exp(-2 * z * z) - (1 - std::exp(-2 * z * z)) / (z * z));
}

struct NamedGrid {
  const char* name;
  testdata::Grid grid;
};

std::vector<NamedGrid> grids() {
  testdata::Grid even;
  even.size = glm::ivec3(64);
  testdata::Grid thick = even;
  thick.spacing.z = 5;
  thick.size.z = 14;
  testdata::Grid oblique = rotated(even, {1, 2, 3}, 35);
  testdata::Grid tilted = even;
  tilted.tilt_degrees = 20;
  tilted.size = {64, 70, 70};
  testdata::Grid thick_tilted = thick;
  thick_tilted.tilt_degrees = 20;
  thick_tilted.size = {64, 70, 16};
  testdata::Grid uneven = even;
  uneven.uneven_mm = 0.3;
  return {{"1x1x1", even},
          {"1x1x5", thick},
          {"1x1x1 oblique", oblique},
          {"1x1x1 tilted 20", tilted},
          {"1x1x5 tilted 20", thick_tilted},
          {"1x1x1 uneven 0.3", uneven}};
}

/// Errors at points spread evenly over a sphere of 20 mm, sampled as a proxy would.
void tabulate_errors(const std::filesystem::path& folder) {
  constexpr double radius = 20;
  constexpr int points = 2000;
  Table table("grid,noise_hu,scale_mm,direction_worst_deg,direction_rms_deg,magnitude_worst_percent");
  for (const auto& [name, grid] : grids()) {
    for (const double noise : {0.0, 20.0}) {
      const auto volume = std::make_shared<const io::Volume>(
          testdata::scan(testdata::make_sphere(radius), testdata::make_geometry(grid), {.noise = noise}));
      for (const double scale : {1.0, 1.5, 2.0, 3.0}) {
        const io::VolumeFields fields(volume, both, scale, {.brick_bytes = 0, .background = false});
        double worst = 0;
        double squares = 0;
        double worst_magnitude = 0;
        for (int n = 0; n < points; ++n) {
          const double z = 1 - (2 * n + 1.0) / points;  // Fibonacci's spiral
          const double angle = n * 2.399963229728653;
          const double r = std::sqrt(1 - z * z);
          const Vec3 normal(r * std::cos(angle), r * std::sin(angle), z);
          const Vec3 g = fields.sample(radius * normal, both).gradient;
          const double error = glm::degrees(std::atan2(glm::length(glm::cross(normal, g)), -glm::dot(normal, g)));
          worst = std::max(worst, error);
          squares += error * error;
          worst_magnitude = std::max(worst_magnitude, std::abs(glm::length(g) / slope_at_surface(radius, scale) - 1));
        }
        table.add(fmt::format("{},{:.0f},{},{:.2f},{:.2f},{:.1f}", name, noise, scale, worst,
                              std::sqrt(squares / points), 100 * worst_magnitude));
      }
    }
  }
  table.save(folder, "gradient_errors.csv");
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

void tabulate_times(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder) {
  const double scale = io::default_gradient_scale_mm(volume->geometry);
  const glm::ivec3 size = volume->geometry.dimensions;
  const io::GradientKernel kernel(volume, scale);
  Table table("what,time,unit");
  for (const int threads : {1, 0}) {
    const auto start = Clock::now();
    const auto gradients = kernel.whole({}, threads);
    table.add(fmt::format("gradient of {}x{}x{} at {:.2g} mm on {},{:.2f},s", size.x, size.y, size.z, scale,
                          threads == 1 ? "1 thread" : "all cores", seconds_since(start)));
  }
  std::vector<glm::vec3> brick(17 * 17 * 17);
  const double fill = microseconds(50, [&](int n) { kernel.at_block({size / 3 + n, glm::ivec3(17)}, brick); });
  table.add(fmt::format("a brick of 16x16x16 cells,{:.0f},us", fill));

  const io::VolumeFields missing(volume, both, scale, {.brick_bytes = 0, .background = false});
  const io::VolumeFields hot(volume, both, scale, {.background = false});
  hot.prepare(Vec3(0), 20);
  double sum = 0;  // so that no sample is optimised away
  const auto at = [](int n) { return Vec3(n % 97, n % 89, n % 83) * 0.1; };
  const auto far = [](int n) { return Vec3((n * 37) % 40 - 20, (n * 23) % 40 - 20, (n * 29) % 40 - 20); };
  const double value = microseconds(5000, [&](int n) { sum += hot.sample(at(n), io::FieldSet::value).value; });
  const double near = microseconds(5000, [&](int n) { sum += hot.sample(at(n), both).gradient.x; });
  const double cold = microseconds(5000, [&](int n) { sum += hot.sample(far(n), both).gradient.x; });
  const double alone = microseconds(1000, [&](int n) { sum += missing.sample(at(n), both).gradient.x; });
  table.add(fmt::format("value of a sample,{:.3f},us", value));
  table.add(fmt::format("value and gradient from a brick,{:.3f},us", near));
  table.add(fmt::format("the same from a brick at random,{:.3f},us", cold));
  table.add(fmt::format("the same with the brick missing,{:.1f},us", alone));
  if (!std::isfinite(sum)) fmt::print("{}\n", sum);
  table.save(folder, "field_times.csv");
}

/// A stylus at 1 kHz on a winding way: how many samples find no brick.
void tabulate_misses(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder) {
  constexpr double seconds = 5;
  const double scale = io::default_gradient_scale_mm(volume->geometry);
  Table table("speed_mm_per_s,samples,missing_percent,memory_mib");
  for (const double speed : {50.0, 200.0, 500.0}) {
    const io::VolumeFields fields(volume, both, scale);
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
      missing += !fields.sample(p, both).from_brick;
      next += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(next);
    }
    table.add(fmt::format("{:.0f},{},{:.2f},{:.1f}", speed, ticks, 100.0 * missing / ticks,
                          static_cast<double>(fields.memory_bytes()) / 1048576));
  }
  table.save(folder, "brick_misses.csv");
}

/// How far the direction turns under a tremor of 0.05 mm, at points of a scan where there is a boundary.
void tabulate_jitter(const io::Volume& loaded, const std::filesystem::path& folder) {
  constexpr double tremor_mm = 0.05;  // rms along each axis
  constexpr int wanted = 500;
  constexpr int shakes = 20;
  const auto volume = std::make_shared<const io::Volume>(loaded);
  Table table("scale_mm,points,direction_rms_deg,direction_p95_deg");
  for (const double scale : {1.0, 1.5, 2.0, 3.0}) {
    const io::VolumeFields fields(volume, both, scale, {.brick_bytes = 0, .background = false});
    std::mt19937 random(1);
    std::normal_distribution<double> tremor(0, tremor_mm);
    std::uniform_real_distribution<double> anywhere(0, 1);
    std::vector<double> angles;
    int points = 0;
    for (int n = 0; n < 200 * wanted && points < wanted; ++n) {
      const Vec3 index =
          Vec3(anywhere(random), anywhere(random), anywhere(random)) * Vec3(volume->geometry.dimensions - 1);
      const Vec3 p = volume->geometry.to_patient(index);
      const Vec3 g = fields.sample(p, both).gradient;
      constexpr double boundary = 40;  // per mm: skin and bone of a CT are far above
      if (glm::length(g) < boundary) continue;
      ++points;
      for (int m = 0; m < shakes; ++m) {
        const Vec3 h = fields.sample(p + Vec3(tremor(random), tremor(random), tremor(random)), both).gradient;
        angles.push_back(glm::degrees(std::atan2(glm::length(glm::cross(g, h)), glm::dot(g, h))));
      }
    }
    if (angles.empty()) {
      table.add(fmt::format("{},0,,", scale));
      continue;
    }
    double squares = 0;
    for (const double a : angles) squares += a * a;
    std::sort(angles.begin(), angles.end());
    table.add(fmt::format("{},{},{:.3f},{:.3f}", scale, points, std::sqrt(squares / static_cast<double>(angles.size())),
                          angles[angles.size() * 95 / 100]));
  }
  table.save(folder, "direction_jitter.csv");
}

void run_all(const FieldsArguments& arguments, const std::filesystem::path& folder) {
  tabulate_errors(folder);
  const auto volume = large_volume(arguments.quick);
  tabulate_times(volume, folder);
  tabulate_misses(volume, folder);
  if (!arguments.series.path.empty()) {
    tabulate_jitter(load_series(arguments.series), folder);
  }
}

void run(const FieldsArguments& arguments) {
  if (arguments.output.empty()) {
    run_all(arguments, {});
    return;
  }
  testdata::FreshFolder folder(arguments.output);
  run_all(arguments, folder.path());
  folder.commit();
}

}  // namespace

void add_bench_fields(CLI::App& bench) {
  auto arguments = std::make_shared<FieldsArguments>();
  CLI::App* command =
      bench.add_subcommand("fields", "Gradients: errors on phantoms, run times, bricks ahead of a stylus");
  command->add_option("SERIES", arguments->series.path, "A scan: also the jitter of its gradient's direction at rest");
  command->add_option("--series", arguments->series.series, "Which series, by number or UID");
  command->add_option("-o,--output", arguments->output, "Also write CSV to this folder; new or empty");
  command->add_flag("--quick", arguments->quick, "Times on an eighth of the volume");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace palpate::plugin
