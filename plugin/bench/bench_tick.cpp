#include "plugin/bench/bench_tick.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>

#include "device/simulated/simulated_stylus.h"
#include "io/fields/volume_fields.h"
#include "io/fresh_folder.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/run_session.h"
#include "plugin/bench/place_study.h"
#include "plugin/bench/sphere_study.h"
#include "plugin/bench/tick_study.h"
#include "plugin/messages/messages.h"
#include "plugin/options/probe_path.h"
#include "plugin/options/series_option.h"
#include "plugin/report/text_file.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

struct Arguments {
  SeriesOption series;
  ProbePathOption path;
  std::string output;
  std::size_t ticks = 200000;
  int largest = 1024;
  bool sphere = false;
  bool place = false;
};

/// Rows on stdout, kept for the CSV.
class Rows {
 public:
  void add(const TickRow& row) {
    fmt::print("{}\n", to_text(row));
    csv_ += to_csv(row);
  }
  const std::string& csv() const { return csv_; }

 private:
  std::string csv_ = tick_csv_header();
};

modes::Scene surface_and_friction() {
  return modes::scene_from_json(R"({"version": 1, "name": "surface and friction", "modes": [
    {"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [60, 1.5]]}},
    {"type": "friction", "strength_n": {"of": "value", "nodes": [[-310, 0], [-290, 0.1]]}}]})",
                                "bench tick");
}

/// As many surfaces, that share 1.5 N; on both sides each places two planes.
modes::Scene surfaces(int count, bool both) {
  std::string text = R"({"version": 1, "modes": [)";
  for (int n = 0; n < count; ++n) {
    text += fmt::format(
        R"({}{{"type": "surface", "side": "{}", "strength_n": {{"of": "gradient_per_mm", "nodes": [[20, 0], [60, {}]]}}}})",
        n > 0 ? "," : "", both ? "both" : "entering", 1.5 / count);
  }
  return modes::scene_from_json(text + "]}", "bench tick");
}

/// A scan with a hand's path on it.
struct Walk {
  std::shared_ptr<const io::Volume> volume;
  modes::WorkspaceSettings workspace;
  std::vector<glm::dvec3> poses_m;
};

/// The poses of the main job's press: in the air, on the skin, along it, through to the bone.
Walk press_on(const Arguments& arguments) {
  Walk walk{
      .volume = std::make_shared<const io::Volume>(load_series(arguments.series)), .workspace = {}, .poses_m = {}};
  const auto stylus = std::make_shared<device::SimulatedStylus>();
  const device::Specification specification = stylus->specification();
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  PreparedScene felt = prepare(scene, walk.volume, specification.workspace_half_extent);
  const double end_s = follow_probe_path(arguments.path, *walk.volume, scene, felt, *stylus);
  walk.workspace = scene.workspace;
  Session session(snapshot_of(scene, felt, specification), stylus);
  for (int n = 0; n < static_cast<int>(end_s * specification.rate); ++n) {
    const TickRecord& tick = session.tick();
    walk.poses_m.emplace_back(tick.probe_m[0], tick.probe_m[1], tick.probe_m[2]);
  }
  return walk;
}

Snapshot on(const Walk& walk, modes::Scene scene, const io::FieldOptions& options = {}) {
  scene.workspace = walk.workspace;
  const device::Specification specification = device::SimulatedStylus().specification();
  PreparedScene felt{.plan = plan_for(scene, *walk.volume, specification.workspace_half_extent), .source = nullptr};
  felt.source = std::make_shared<const io::VolumeFields>(walk.volume, felt.plan->fields,
                                                         io::default_gradient_scale_mm(walk.volume->geometry), options);
  return snapshot_of(scene, felt, specification);
}

/// How the hand goes over the hills: smoothly, 2 mm deep at 50 mm/s; by random steps of 0.5 mm, which is the speed
/// limit's half; or anywhere in the volume every tick, as no hand can.
enum class Gait { smooth, random, anywhere };
constexpr const char* gait_names[] = {"smooth walk", "random walk", "anywhere each tick"};

/// A cube of voxels of 1 mm with hills of tissue under air.
Walk hills(int size, Gait gait) {
  testdata::Grid grid;
  grid.size = glm::ivec3(size);
  io::Volume volume;
  volume.geometry = testdata::make_geometry(grid);
  volume.modality = "CT";
  volume.unit = "HU";
  const auto count = static_cast<std::size_t>(size);
  std::vector<std::int16_t> voxels(count * count * count);
  const auto height = [](double x, double y) { return 4 * std::sin(x / 15) + 4 * std::cos(y / 15); };
  const double half = 0.5 * (size - 1);
  std::size_t at = 0;
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i, ++at) {
        const double depth = height(i - half, j - half) - (k - half);
        voxels[at] = static_cast<std::int16_t>(-480 + std::clamp(260 * depth, -520.0, 520.0));
      }
    }
  }
  volume.voxels = std::move(voxels);
  Walk walk{.volume = std::make_shared<const io::Volume>(std::move(volume)), .workspace = {}, .poses_m = {}};
  const modes::Workspace workspace;
  std::mt19937_64 numbers(1);
  std::uniform_real_distribution<double> anywhere(-0.4 * size, 0.4 * size);
  std::normal_distribution<double> step(0, 0.5 / std::sqrt(3.0));
  glm::dvec3 at_mm(0);
  double depth_mm = 0;
  for (int n = 0; n < 20000; ++n) {
    if (gait == Gait::smooth) {
      const double angle = 0.05 / 35 * n;
      at_mm = {35 * std::cos(angle), 35 * std::sin(angle), 0};
      at_mm.z = height(at_mm.x, at_mm.y) - 2 * std::min(1.0, n / 200.0);
    } else if (gait == Gait::random) {
      // Never far from the hills' surface.
      depth_mm = std::clamp(depth_mm + step(numbers), -1.0, 2.0);
      at_mm.x = std::clamp(at_mm.x + step(numbers), -40.0, 40.0);
      at_mm.y = std::clamp(at_mm.y + step(numbers), -40.0, 40.0);
      at_mm.z = height(at_mm.x, at_mm.y) - depth_mm;
    } else {
      at_mm = {anywhere(numbers), anywhere(numbers), anywhere(numbers)};
    }
    walk.poses_m.push_back(workspace.to_device(at_mm));
  }
  return walk;
}

void tabulate_series(const Arguments& arguments, Rows& rows) {
  const Walk walk = press_on(arguments);
  fmt::print("On {}, the main job's press, {} ticks a row\n\n{}\n", describe_scan(*walk.volume), arguments.ticks,
             tick_row_header());
  const auto measure = [&](const std::string& what, const Snapshot& snapshot) {
    rows.add(measure_ticks(what, snapshot, walk.poses_m, arguments.ticks));
  };
  const modes::Scene three = modes::load_scene("ct-skin-and-bone");
  measure("surface + friction", on(walk, surface_and_friction()));
  measure("three modes: skin, bone, friction", on(walk, three));
  const io::FieldOptions no_bricks{.brick_bytes = 0, .background = false};
  measure("surface + friction, brick missed", on(walk, surface_and_friction(), no_bricks));
  {
    const BusyThread busy;
    measure("surface + friction, busy neighbor", on(walk, surface_and_friction()));
    measure("three modes, busy neighbor", on(walk, three));
  }
  const auto at_1_khz = [&](const std::string& what, const Snapshot& snapshot, Between between) {
    rows.add(measure_ticks(what, snapshot, walk.poses_m, std::min<std::size_t>(arguments.ticks, 10000), 1000, between));
  };
  at_1_khz("surface + friction, at 1 kHz", on(walk, surface_and_friction()), Between::asleep);
  at_1_khz("nothing to feel, at 1 kHz", on(walk, surfaces(0, false)), Between::asleep);
  at_1_khz("surface + friction, awake at 1 kHz", on(walk, surface_and_friction()), Between::awake);
  at_1_khz("nothing to feel, awake at 1 kHz", on(walk, surfaces(0, false)), Between::awake);
  fmt::print("\nGrowth with modes, and with primitives\n");
  for (int modes = 1; modes <= 8; ++modes) measure(fmt::format("{} surfaces", modes), on(walk, surfaces(modes, false)));
  for (int modes = 1; modes <= 8; modes *= 2) {
    measure(fmt::format("{} surfaces on both sides", modes), on(walk, surfaces(modes, true)));
  }
}

void tabulate_sizes(const Arguments& arguments, Rows& rows) {
  fmt::print("\nGrowth with the volume: hills of tissue, surface + friction, no sub-steps\n");
  modes::Scene scene = surface_and_friction();
  scene.subdivision.most = 1;
  for (const Gait gait : {Gait::smooth, Gait::random, Gait::anywhere}) {
    for (int size = 128; size <= arguments.largest; size *= 2) {
      const Walk walk = hills(size, gait);
      rows.add(measure_ticks(fmt::format("{}^3, {}", size, gait_names[static_cast<std::size_t>(gait)]), on(walk, scene),
                             walk.poses_m, arguments.ticks / (gait == Gait::anywhere ? 4 : 1)));
    }
  }
}

void run(const Arguments& arguments, const std::filesystem::path& folder) {
  std::string csv;
  if (arguments.sphere) {
    csv = run_sphere_study();
  } else if (arguments.place) {
    csv = run_place_study();
  } else {
    Rows rows;
    tabulate_series(arguments, rows);
    tabulate_sizes(arguments, rows);
    fmt::print("\nCHAI3D's voxel haptics, measured elsewhere and not run here: 4.8 to 28 us a tick.\n");
    csv = rows.csv();
  }
  if (!folder.empty())
    write_text(folder / (arguments.sphere ? "sphere.csv" : arguments.place ? "place.csv" : "tick.csv"), csv);
}

}  // namespace

void add_bench_tick(CLI::App& bench) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = bench.add_subcommand(
      "tick", "The time of a tick, stage by stage, and how it grows; with --sphere the error on a known shape.");
  add_series_option(*command, arguments->series);
  command->get_option("SERIES")->required(false);
  add_probe_path_option(*command, arguments->path);
  command->add_flag("--sphere", arguments->sphere, "use a sphere of 5 cm, 128^3 and 256^3 voxels, instead of a series");
  command->add_flag("--place", arguments->place,
                    "measure how far the felt boundary is from the true one, against time");
  command->add_option("--ticks", arguments->ticks, "ticks for each row of the table")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{100000000}))
      ->capture_default_str();
  command->add_option("--largest", arguments->largest, "edge of the largest volume made, voxels (1024: 2 GiB)")
      ->check(CLI::Range(128, 1024))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "also write a CSV file to this new or empty folder");
  command->callback([arguments] {
    if (arguments->series.path.empty() && !arguments->sphere && !arguments->place) {
      throw WrongUsage(say("tick-needs-a-scan"));
    }
    io::write_all_or_none(arguments->output, [&](const std::filesystem::path& folder) { run(*arguments, folder); });
  });
}

}  // namespace palpate::plugin
