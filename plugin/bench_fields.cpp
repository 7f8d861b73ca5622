#include "palpate/plugin/bench_fields.h"

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

struct Method {
  std::string name;
  io::GradientMethod gradient = io::GradientMethod::gaussian;
  double scale_mm = 0;
};

std::vector<Method> methods() {
  return {{"gaussian", io::GradientMethod::gaussian, 1.0},      {"gaussian", io::GradientMethod::gaussian, 1.5},
          {"gaussian", io::GradientMethod::gaussian, 2.0},      {"gaussian", io::GradientMethod::gaussian, 3.0},
          {"central", io::GradientMethod::central_differences}, {"b-spline", io::GradientMethod::cubic_b_spline}};
}

/// What voxels do to a Gaussian's width along a normal: averaging over a voxel adds a twelfth of its edge's square, and
/// linear interpolation between voxels f (1 - f) of it.
double widened(double scale, const io::Geometry& g, const Vec3& position, const Vec3& normal) {
  const Vec3 index = g.to_index(position);
  const Vec3 f = index - glm::floor(index);
  const Vec3 edges[] = {g.spacing_i * g.direction_i, g.spacing_j * g.direction_j,
                        g.slice_spacing() * glm::cross(g.direction_i, g.direction_j)};
  const Vec3 steps[] = {edges[0], edges[1], g.step};
  double variance = scale * scale;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = glm::dot(edges[axis], normal);
    const double step = glm::dot(steps[axis], normal);
    variance += edge * edge / 12 + f[axis] * (1 - f[axis]) * step * step;
  }
  return std::sqrt(variance);
}

struct Errors {
  double direction_worst = 0;
  double direction_rms = 0;
  double magnitude_worst = 0;    ///< against the Gaussian alone
  double unexplained_worst = 0;  ///< against the Gaussian that voxels have widened
};

/// At points spread evenly over a sphere, sampled as a proxy would.
Errors errors_on_sphere(const std::shared_ptr<const io::Volume>& volume, const Method& method, double radius) {
  constexpr int points = 2000;
  const io::VolumeFields fields(volume, both, method.scale_mm,
                                {.gradient = method.gradient, .brick_bytes = 0, .background = false});
  Errors errors;
  for (int n = 0; n < points; ++n) {
    const double z = 1 - (2 * n + 1.0) / points;  // Fibonacci's spiral
    const double angle = n * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    const Vec3 normal(r * std::cos(angle), r * std::sin(angle), z);
    const Vec3 g = fields.sample(radius * normal, both).gradient;
    const double degrees = glm::degrees(std::atan2(glm::length(glm::cross(normal, g)), -glm::dot(normal, g)));
    errors.direction_worst = std::max(errors.direction_worst, degrees);
    errors.direction_rms += degrees * degrees / points;
    if (method.scale_mm > 0) {
      const double wide = widened(method.scale_mm, volume->geometry, radius * normal, normal);
      const auto off = [&](double scale) { return std::abs(glm::length(g) / slope_at_surface(radius, scale) - 1); };
      errors.magnitude_worst = std::max(errors.magnitude_worst, off(method.scale_mm));
      errors.unexplained_worst = std::max(errors.unexplained_worst, off(wide));
    }
  }
  errors.direction_rms = std::sqrt(errors.direction_rms);
  return errors;
}

void tabulate_errors(const std::filesystem::path& folder) {
  constexpr double radius = 20;
  Table table(
      "grid,noise_hu,method,scale_mm,direction_worst_deg,direction_rms_deg,magnitude_worst_percent,"
      "beyond_voxel_blur_percent");
  for (const auto& [name, grid] : grids()) {
    for (const double noise : {0.0, 20.0}) {
      const auto volume = std::make_shared<const io::Volume>(
          testdata::scan(testdata::make_sphere(radius), testdata::make_geometry(grid), {.noise = noise}));
      for (const Method& method : methods()) {
        const Errors e = errors_on_sphere(volume, method, radius);
        const std::string magnitude =
            method.scale_mm > 0 ? fmt::format("{},{:.2f},{:.2f},{:.1f},{:.1f}", method.scale_mm, e.direction_worst,
                                              e.direction_rms, 100 * e.magnitude_worst, 100 * e.unexplained_worst)
                                : fmt::format(",{:.2f},{:.2f},,", e.direction_worst, e.direction_rms);
        table.add(fmt::format("{},{:.0f},{},{}", name, noise, method.name, magnitude));
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

/// Fresh memory for a whole gradient, as the kernel hands it out or in large pages where it can.
class Output {
 public:
  Output(std::size_t count, bool large_pages) : count_(count) {
    constexpr std::size_t large = std::size_t{2} << 20;
    const std::size_t bytes = (count * sizeof(glm::vec3) + large - 1) / large * large;
    memory_.reset(std::aligned_alloc(large, bytes));
    if (!memory_) throw std::bad_alloc();
    ::madvise(memory_.get(), bytes, large_pages ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);
  }
  std::span<glm::vec3> span() const { return {static_cast<glm::vec3*>(memory_.get()), count_}; }

 private:
  struct Free {
    void operator()(void* memory) const { std::free(memory); }  // NOLINT: of aligned_alloc
  };
  std::size_t count_;
  std::unique_ptr<void, Free> memory_;
};

/// Best of three, each into fresh memory.
double best_seconds(std::size_t count, bool large_pages, const std::function<void(std::span<glm::vec3>)>& write) {
  double best = 1e300;
  for (int run = 0; run < 3; ++run) {
    const Output output(count, large_pages);
    const auto start = Clock::now();
    write(output.span());
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
  Table table("whole volume,threads,pages,seconds");
  for (const bool large : {false, true}) {
    const char* const pages = large ? "large" : "small";
    const double cold = best_seconds(
        count, large, [](std::span<glm::vec3> to) { std::memset(static_cast<void*>(to.data()), 1, to.size_bytes()); });
    table.add(fmt::format("cold write of the output,1,{},{:.3f}", pages, cold));
    for (const int threads : {1, 0}) {
      const std::string how = fmt::format("{},{}", threads == 1 ? "1" : "all", pages);
      const auto take = [&](const io::GradientKernel& kernel) {
        return best_seconds(count, large, [&](std::span<glm::vec3> to) { kernel.whole_into(to, {}, threads); });
      };
      const double differences = take(central);
      const double filtered = take(gaussian);
      table.add(fmt::format("central differences,{},{:.3f}", how, differences));
      table.add(fmt::format("gaussian of {:.2g} mm,{},{:.3f}", gaussian.scale_mm(), how, filtered));
      fmt::print("# central / cold write {:.2f}, gaussian / central {:.2f}\n", differences / cold,
                 filtered / differences);
    }
  }
  for (const auto& [name, program] :
       {std::pair{"vtkImageGradient", "gradient_by_vtk"}, std::pair{"ITK recursive gaussian", "gradient_by_itk"}}) {
    if (const auto seconds = peer_seconds(program, size)) {
      table.add(fmt::format("{},all,small,{:.3f}", name, *seconds));
    } else {
      fmt::print("# {}: {} is not beside this program (-DPALPATE_PEERS=ON builds it where it can)\n", name, program);
    }
  }
  table.save(folder, "whole_volume_times.csv");
}

void tabulate_samples(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder) {
  const double scale = io::default_gradient_scale_mm(volume->geometry);
  const io::GradientKernel kernel(volume, scale);
  Table table("sample,microseconds");
  std::vector<glm::vec3> brick(17 * 17 * 17);
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
       {Row{"value", io::FieldSet::value}, Row{"value and gradient", both},
        Row{"value; central differences", both, io::GradientMethod::central_differences},
        Row{"value and gradient by b-spline", both, io::GradientMethod::cubic_b_spline},
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
  tabulate_whole_volumes(volume, folder);
  tabulate_samples(volume, folder);
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
