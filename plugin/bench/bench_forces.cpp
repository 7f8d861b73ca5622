#include "plugin/bench/bench_forces.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/fresh_folder.h"
#include "io/structures/structure.h"
#include "plugin/app/errors.h"
#include "plugin/app/interruptible.h"
#include "plugin/app/open_scan.h"
#include "plugin/bench/force_labels.h"
#include "plugin/bench/force_phantom.h"
#include "plugin/bench/force_tables.h"
#include "plugin/bench/trajectories.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

struct ForcesArguments {
  SeriesOption series;
  std::vector<fs::path> structures;
  std::size_t paths = 30000;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string only;
  fs::path trajectory;
  std::string columns = usual_columns, scene;
  double stiffness_n_per_mm = 0.5;
  std::string output;
};

std::vector<ForceGroup> groups_of(const ForcesArguments& arguments) {
  std::vector<ForceGroup> groups = phantom_groups(arguments.seed);
  if (!arguments.structures.empty()) {
    const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
    const io::StructureCatalogue found = io::find_structures(arguments.structures);
    fmt::print("On {}\n", describe_scan(*volume));
    auto labels = label_groups(volume, found, arguments.seed);
    std::ranges::move(labels, std::back_inserter(groups));
  }
  std::erase_if(groups, [&](const ForceGroup& group) { return group.name.find(arguments.only) == std::string::npos; });
  return groups;
}

void run_forces(const ForcesArguments& arguments, const fs::path& folder) {
  const auto begun = std::chrono::steady_clock::now();
  const std::vector<ForceGroup> groups = groups_of(arguments);
  std::size_t rows = 0;
  for (const ForceGroup& group : groups) rows += group.rows.size();
  if (rows == 0) return;
  const ForceOptions options{.paths_a_row = std::max<std::size_t>(1, arguments.paths / rows),
                             .seed = arguments.seed,
                             .threads = arguments.threads};
  fmt::print("{} rows of {} paths, seed {}\n", rows, options.paths_a_row, options.seed);
  for (const ForceGroup& group : groups) fmt::print("{}: compared with {}\n", group.name, group.against);
  std::fflush(stdout);
  std::vector<ForceRowResult> results;
  {
    const Interruptible ctrl_c;
    const io::Progress shown = terminal_progress("paths");
    results = compare_forces(groups, options, [&](double done) {
      if (shown) shown(done);
      return !Interruptible::interrupted();
    });
  }
  print_forces(results);
  print_known(results);
  for (const ForceGroup& group : groups) {
    if (group.name == scenes_group) print_pairs(results, group.name);
  }
  fmt::print("\n{:.0f} s\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
  if (folder.empty()) return;
  write_text(folder / "forces.csv", forces_csv(results, arguments.seed, true));
  write_text(folder / "known.csv", known_csv(results, arguments.seed));
  write_text(folder / "pairs.csv", pairs_csv(results, arguments.seed));
  write_png(error_against_time(results), folder / "force-error-time.png", 960, 640);
}

void run_trajectory(const ForcesArguments& arguments, const fs::path& folder) {
  if (arguments.series.path.empty()) throw WrongUsage(say("trajectories-need-a-scan"));
  const auto samples = read_trajectory(arguments.trajectory, arguments.columns);
  const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
  const FeltScene felt = felt_on_scan(scene_for(arguments.scene, *volume), volume);
  const ForceErrors errors = compare_with_measured(samples, felt, arguments.stiffness_n_per_mm);
  const std::string file = arguments.trajectory.filename().string();
  put("{} samples of {}, felt on {} with the scene \"{}\" and {} N/mm\n", samples.size(), file, describe_scan(*volume),
      felt.scene.name, arguments.stiffness_n_per_mm);
  put("force error: RMS {:.3f} N, 95 % within {:.3f} N, largest {:.2f} N, {:.1f} % above {} N\n", errors.rms_n(),
      errors.p95_n(), errors.largest_n(), 100 * errors.affected(), affected_n);
  if (folder.empty()) return;
  write_text(
      folder / "trajectory.csv",
      fmt::format("samples,stiffness_n_per_mm,rms_n,p95_n,largest_n,affected\n{},{},{:.6f},{:.3f},{:.6f},{:.6f}\n",
                  samples.size(), arguments.stiffness_n_per_mm, errors.rms_n(), errors.p95_n(), errors.largest_n(),
                  errors.affected()));
}

}  // namespace

void add_bench_forces(CLI::App& bench) {
  const auto arguments = std::make_shared<ForcesArguments>();
  CLI::App* command = bench.add_subcommand(
      "forces",
      "How far the force that is felt is from the true one, along random straight paths: phantoms, outlines, "
      "automatic scenes, filters, solvers.");
  add_series_option(*command, arguments->series);
  CLI::Option* const structures =
      command->add_option("--structures", arguments->structures, "reference labels: SEG, RTSTRUCT or label map")
          ->check(CLI::ExistingPath);
  CLI::Option* const trajectory =
      command->add_option("--trajectories", arguments->trajectory,
                          "a stroke measured on the object that SERIES shows: text, one sample a line");
  command->get_option("SERIES")->required(false);
  structures->needs("SERIES")->excludes(trajectory);
  command
      ->add_option("--columns", arguments->columns,
                   "what the columns of the stroke's file are, in mm and N; - skips one")
      ->needs(trajectory)
      ->capture_default_str();
  command->add_option("--scene", arguments->scene, "the scene for the stroke: a file or a starting scene")
      ->needs(trajectory);
  command->add_option("--stiffness", arguments->stiffness_n_per_mm, "stiffness of the hand in the stroke, N/mm")
      ->needs(trajectory)
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  command->add_option("--paths", arguments->paths, "number of paths, over all rows")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "seed of the paths and the noise")->capture_default_str();
  command
      ->add_option("--threads", arguments->threads,
                   "how many threads; 0: one for each core. The figures do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("--only", arguments->only, "only groups whose name contains this");
  command->add_option("-o,--output", arguments->output, "also write CSV and a picture to this new or empty folder");
  command->callback([arguments] {
    io::write_all_or_none(arguments->output, [&](const fs::path& folder) {
      arguments->trajectory.empty() ? run_forces(*arguments, folder) : run_trajectory(*arguments, folder);
    });
  });
}

}  // namespace palpate::plugin
