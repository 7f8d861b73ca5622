#include "plugin/bench/bench_structures.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "io/fresh_folder.h"
#include "io/structures/structure.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/run_session.h"
#include "plugin/bench/ball_rays.h"
#include "plugin/bench/scan_edge_study.h"
#include "plugin/bench/tick_study.h"
#include "plugin/options/series_option.h"
#include "plugin/report/text_file.h"
#include "plugin/structures/shared_distance.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

struct StructureArguments {
  SeriesOption series;
  std::vector<fs::path> structures;
  std::string output;
  std::size_t ticks = 100000;
};

double seconds_of(const auto& work) {
  const auto from = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

/// A ball around a place that is not a voxel's center, on voxels of 1 x 1 x `step` mm.
io::Mask ball(double radius, double step, const glm::dvec3& center) {
  io::Mask mask;
  io::Geometry& geometry = mask.geometry;
  const double extent = radius + 3 * step + 3;
  geometry.dimensions = glm::ivec3(glm::ceil(2.0 * extent / glm::dvec3(1, 1, step)));
  geometry.step = {0, 0, step};
  const glm::dvec3 first = -0.5 * glm::dvec3(geometry.dimensions - 1) * glm::dvec3(1, 1, step);
  for (int k = 0; k < geometry.dimensions.z; ++k) {
    geometry.slice_positions.push_back(first + glm::dvec3(0, 0, k * step));
  }
  mask.size = geometry.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const bool inside = glm::distance(geometry.to_patient(glm::dvec3(i, j, k)), center) < radius;
        mask.occupancy.push_back(inside ? io::Mask::full : 0);
      }
    }
  }
  return mask;
}

struct Error {
  double largest_mm = 0, rms_mm = 0, largest_degrees = 0;
};

/// Where rays from the center meet the surface.
Error error_of(const io::DistanceField& field, double radius, const glm::dvec3& center) {
  constexpr int rays = 4000;
  Error error;
  std::mt19937 random(1);
  std::normal_distribution<double> any;
  for (int n = 0; n < rays; ++n) {
    const glm::dvec3 way = any_direction(random, any);
    const double in = radius_along(field, center, way, radius + 6);
    const double off = in - radius;
    const glm::dvec3 inward = glm::normalize(field.sample(center + in * way).gradient);
    error.largest_mm = std::max(error.largest_mm, std::abs(off));
    error.rms_mm += off * off / rays;
    error.largest_degrees =
        std::max(error.largest_degrees, glm::degrees(std::acos(std::clamp(-glm::dot(inward, way), -1.0, 1.0))));
  }
  error.rms_mm = std::sqrt(error.rms_mm);
  return error;
}

std::string tabulate_balls() {
  std::string csv = "radius_mm,slices_mm,largest_mm,rms_mm,largest_degrees,seconds\n";
  fmt::print("Balls on voxels of 1 x 1 x h mm, 4000 rays\n\n{:>10} {:>8} {:>12} {:>10} {:>12} {:>8}\n", "radius mm",
             "h mm", "largest mm", "rms mm", "normal deg", "s");
  constexpr std::array<std::array<double, 2>, 4> balls{{{20, 1}, {20, 3}, {20, 5}, {3, 1}}};
  for (const auto& [radius, step] : balls) {
    const glm::dvec3 center(0.31, -0.17, 0.23 * step);
    const io::Mask mask = ball(radius, step, center);
    std::shared_ptr<const io::DistanceField> field;
    const double seconds = seconds_of([&] { field = io::distance_of(mask); });
    const Error error = error_of(*field, radius, center);
    fmt::print("{:10.0f} {:8.0f} {:12.2f} {:10.3f} {:12.1f} {:8.2f}\n", radius, step, error.largest_mm, error.rms_mm,
               error.largest_degrees, seconds);
    csv += fmt::format("{},{},{},{},{},{}\n", radius, step, error.largest_mm, error.rms_mm, error.largest_degrees,
                       seconds);
  }
  return csv;
}

/// A hundred balls in 512 x 512 x 200 voxels, as NIfTI.
void write_hundred(const fs::path& file) {
  constexpr int columns = 512, rows = 512, slices = 200;
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(header.data() + at, &value, sizeof value); };
  put(0, std::int32_t{348});
  for (const auto& [at, value] :
       {std::pair{40, 3}, {42, columns}, {44, rows}, {46, slices}, {48, 1}, {70, 2}, {72, 8}}) {
    put(static_cast<std::size_t>(at), static_cast<std::int16_t>(value));
  }
  for (int n = 0; n < 4; ++n) put(76 + 4 * static_cast<std::size_t>(n), n == 3 ? 1.5F : n == 0 ? 1.0F : 0.8F);
  put(108, 352.0F);
  put(123, std::uint8_t{2});
  put(252, std::int16_t{1});
  header.replace(344, 3, "n+1");
  std::string voxels(static_cast<std::size_t>(columns) * rows * slices, '\0');
  for (int n = 0; n < 100; ++n) {
    const glm::ivec3 middle(26 + 51 * (n % 10), 26 + 51 * (n / 10), 40 + 120 * (n % 2));
    const double radius = 8 + n % 14;
    for (int k = -30; k <= 30; ++k) {
      for (int j = -24; j <= 24; ++j) {
        for (int i = -24; i <= 24; ++i) {
          if (glm::length(glm::dvec3(0.8 * i, 0.8 * j, 1.5 * k)) >= radius) continue;
          const glm::ivec3 at = middle + glm::ivec3(i, j, k);
          voxels[(static_cast<std::size_t>(at.z) * rows + static_cast<std::size_t>(at.y)) * columns +
                 static_cast<std::size_t>(at.x)] = static_cast<char>(n + 1);
        }
      }
    }
  }
  std::ofstream(file, std::ios::binary) << header << voxels;
}

std::string tabulate_readiness() {
  const fs::path file = fs::temp_directory_path() / "palpate-hundred.nii";
  write_hundred(file);
  io::StructureCatalogue found;
  const double listed = seconds_of([&] { found = io::find_structures(std::array{file}); });
  fmt::print("\n{} labels of 512 x 512 x 200 voxels listed in {:.2f} s\n", found.structures.size(), listed);
  std::string csv = fmt::format("what,seconds,bytes\nlisted,{},\n", listed);
  double slowest = 0;
  std::size_t most = 0;
  for (std::size_t n = 0; n < found.structures.size(); n += 9) {
    std::shared_ptr<const io::DistanceField> field;
    const double ready = seconds_of([&] { field = io::load_distance(found.structures[n]); });
    slowest = std::max(slowest, ready);
    most = std::max(most, field->memory_bytes());
    csv += fmt::format("{},{},{}\n", found.structures[n].name, ready, field->memory_bytes());
  }
  fmt::print("each ready in at most {:.2f} s, in at most {:.1f} MiB\n", slowest, static_cast<double>(most) / (1 << 20));
  fs::remove(file);
  return csv;
}

modes::Scene bare() {
  return modes::scene_from_json(R"({"version": 1, "name": "surface and friction", "modes": [
    {"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1.5]]}},
    {"type": "friction", "strength_n": {"of": "value", "nodes": [[-310, 0], [-290, 0.1]]}}]})",
                                "bench structures");
}

/// A walk of 10 mm to each side of a place, along x, and the structures of the scenes that are felt on it.
struct TickStudy {
  std::string what;
  glm::dvec3 place{0};
  std::vector<io::Structure> felt;
};

/// The scene without structures, with their distances, and kept out of them.
std::string tabulate_ticks_at(const TickStudy& study, const std::shared_ptr<const io::Volume>& volume,
                              std::size_t ticks) {
  std::vector<glm::dvec3> poses;
  const modes::Workspace workspace{.center_mm = study.place};
  for (double x = -10; x < 10; x += 0.05) poses.push_back(workspace.to_device(study.place + glm::dvec3(x, 0, 0)));
  fmt::print("\n{}\n\n{}\n", study.what, tick_row_header());
  std::string csv;
  const device::Specification stylus = device::SimulatedStylus().specification();
  const auto measure = [&](const std::string& what, modes::Scene scene) {
    scene.workspace.center_mm = study.place;
    const TickRow row = measure_ticks(
        what, snapshot_of(scene, prepare(scene, volume, stylus.workspace_half_extent), stylus), poses, ticks);
    fmt::print("{}\n", to_text(row));
    csv += to_csv(row);
    return row.us.median;
  };
  const double without = measure("surface + friction", bare());
  modes::Scene watched = bare(), kept = bare();
  for (std::size_t n = 0; n < study.felt.size(); ++n) {
    modes::Scene one;
    add_keep_out_of(one, study.felt[n], 3);
    // The same structure may come several times.
    one.structures[0].name = one.modes[0].structure = one.modes[0].name = fmt::format("structure {}", n + 1);
    watched.structures.push_back(one.structures[0]);
    kept.structures.push_back(one.structures[0]);
    kept.modes.push_back(one.modes[0]);
  }
  const double with_watched = measure(fmt::format("the same, {} structures told of", study.felt.size()), watched);
  const double with_kept = measure(fmt::format("the same, {} kept out of", study.felt.size()), kept);
  fmt::print("\nmedian tick with them: {:.2f} and {:.2f} times the tick without\n", with_watched / without,
             with_kept / without);
  return csv;
}

using DistanceFields = std::vector<std::shared_ptr<const io::DistanceField>>;

/// Of every eighth voxel of the middle slice: the one in the body farthest from all structures.
glm::dvec3 place_far_from(const DistanceFields& fields, const io::Volume& volume) {
  constexpr double air = -300;
  glm::dvec3 best(0);
  double most = -1e9;
  const glm::ivec3 size = volume.geometry.dimensions;
  for (int j = 0; j < size.y; j += 8) {
    for (int i = 0; i < size.x; i += 8) {
      const glm::dvec3 at = volume.geometry.to_patient(glm::dvec3(i, j, size.z / 2));
      double nearest = 1e9;
      for (const auto& field : fields) nearest = std::min(nearest, -field->sample(at).mm);
      if (nearest > most && volume.value_at(i, j, size.z / 2) > air) {
        most = nearest;
        best = at;
      }
    }
  }
  return best;
}

std::string tabulate_ticks(const StructureArguments& arguments) {
  const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
  std::vector<io::Structure> felt;
  io::StructureCatalogue found = io::find_structures(arguments.structures);
  for (io::Structure& structure : found.structures) {
    if (felt.size() < 5 && place_on(structure, found.registrations, *volume).why_not.empty()) felt.push_back(structure);
  }
  if (felt.empty()) {
    fmt::print("\nNo structure there lies on this scan.\n");
    return tick_csv_header();
  }
  DistanceFields fields;
  for (const io::Structure& structure : felt) fields.push_back(shared_distance(structure, volume->geometry));
  glm::dvec3 edge = io::measure(felt.front()).centroid_mm;
  while (fields.front()->sample(edge).mm > 0) edge.x -= 0.1;
  const glm::dvec3 far = place_far_from(fields, *volume);
  fmt::print("\nOn {}\n", describe_scan(*volume));
  const std::string& name = felt.front().name;
  std::string csv = tick_csv_header();
  for (const TickStudy& study :
       {TickStudy{"in and out of " + name, edge, felt},
        TickStudy{"in and out of " + name + ", which is alone", edge, {felt.front()}},
        TickStudy{"in and out of five that are all " + name, edge, std::vector(5, felt.front())},
        TickStudy{"far from all of them", far, felt}}) {
    csv += tabulate_ticks_at(study, volume, arguments.ticks);
  }
  return csv;
}

}  // namespace

void add_bench_structures(CLI::App& bench) {
  auto arguments = std::make_shared<StructureArguments>();
  CLI::App* command = bench.add_subcommand(
      "structures",
      "Surfaces of label maps: their errors, the time to compute them, and the time that they add to a tick.");
  add_series_option(*command, arguments->series);
  CLI::Option* const structures =
      command
          ->add_option("--structures", arguments->structures, "structures of that series: SEG, RTSTRUCT or label map")
          ->check(CLI::ExistingPath);
  command->get_option("SERIES")->required(false)->needs(structures);
  command->add_option("--ticks", arguments->ticks, "ticks for each row of the table")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "also write CSV files to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const fs::path& folder) {
      const auto keep = [&](const char* name, const std::string& csv) {
        if (!folder.empty()) write_text(folder / name, csv);
      };
      keep("balls.csv", tabulate_balls());
      keep("own_edges.csv", tabulate_own_edges());
      keep("readiness.csv", tabulate_readiness());
      if (!arguments->series.path.empty()) keep("tick.csv", tabulate_ticks(*arguments));
    });
  });
}

}  // namespace palpate::plugin
