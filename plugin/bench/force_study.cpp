#include "plugin/bench/force_study.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "io/parallel.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {
namespace {

// Sums are taken over chunks of a fixed size, and the chunks are added in order.
constexpr std::size_t chunk_paths = 32;

using Paths = std::vector<PlannedPath>;

std::vector<std::string> boundaries_of_scene(const modes::Scene& scene) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < scene.modes.size(); ++n) names.push_back(display_name(scene, n));
  return names;
}

double study_seconds_since(std::chrono::steady_clock::time_point begun) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// Runs over chunks of paths: all threads at once.
struct Runner {
  const ForceOptions& options;
  const io::Progress& progress;
  double done = 0, per_run = 1;

  void over(std::size_t count, const std::function<void(std::size_t first, std::size_t last)>& work) {
    const std::size_t chunks = (count + chunk_paths - 1) / chunk_paths;
    io::internal::parallel_for(
        chunks, [&](std::size_t chunk) { work(chunk * chunk_paths, std::min(count, (chunk + 1) * chunk_paths)); },
        [&](double part) { return !progress || progress(std::min(1.0, done + part * per_run)); }, options.threads);
    done += per_run;
  }

  /// Allows cancelling the preparation; its progress is not reported.
  FeltScene prepared(const MakeFelt& make) const {
    return make([this](double) { return !progress || progress(std::min(1.0, done)); });
  }
};

Paths paths_of(const ForceGroup& group, Runner& runner) {
  std::vector<std::optional<PlannedPath>> planned(runner.options.paths_a_row);
  runner.over(planned.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) planned[n] = plan_path(group.world, runner.options.seed, n);
  });
  Paths paths;
  for (const auto& path : planned) {
    if (path) paths.push_back(*path);
  }
  return paths;
}

std::vector<FeltPath> felt_along(const FeltScene& felt, const Paths& paths, double speed, Runner& runner) {
  std::vector<FeltPath> all(paths.size());
  runner.over(paths.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) all[n] = feel_path(felt, paths[n], speed);
  });
  return all;
}

ForceRowResult run_row(const ForceGroup& group, const ForceRow& row, const Paths& paths,
                       const std::vector<FeltPath>& truth, Runner& runner) {
  ForceRowResult result{.group = group.name, .name = row.name, .boundaries = {}, .truth_boundaries = {}, .errors = {}};
  const auto begun = std::chrono::steady_clock::now();
  const FeltScene felt = runner.prepared(row.make);
  result.ready_s = study_seconds_since(begun);
  result.boundaries = boundaries_of_scene(felt.scene);
  result.paths = paths.size();
  const std::size_t chunks = (paths.size() + chunk_paths - 1) / chunk_paths;
  std::vector<ForceErrors> errors(chunks);
  std::vector<double> us(chunks, std::numeric_limits<double>::infinity());
  runner.over(paths.size(), [&](std::size_t first, std::size_t last) {
    const std::size_t chunk = first / chunk_paths;
    double seconds = 0, ticks = 0;
    for (std::size_t n = first; n < last; ++n) {
      try {
        const FeltPath path = feel_path(felt, paths[n], group.speed_mm_per_s);
        seconds += path.seconds;
        ticks += static_cast<double>(path.force_n.size());
        errors[chunk].add(truth[n], path, group.off_mm);
      } catch (const Refusal&) {  // a solver that does not fit
        errors[chunk].add_refused();
      }
    }
    if (ticks > 0) us[chunk] = 1e6 * seconds / ticks;
  });
  for (const ForceErrors& one : errors) result.errors.merge(one);
  result.us_a_tick = chunks == 0 ? 0 : *std::ranges::min_element(us);
  return result;
}

}  // namespace

std::vector<ForceRowResult> compare_forces(const std::vector<ForceGroup>& groups, const ForceOptions& options,
                                           const io::Progress& progress) {
  double runs = 0;
  for (const ForceGroup& group : groups) runs += 2 + static_cast<double>(group.rows.size());
  Runner runner{.options = options, .progress = progress, .per_run = 1 / runs};
  std::vector<ForceRowResult> results;
  for (const ForceGroup& group : groups) {
    const Paths paths = paths_of(group, runner);
    const FeltScene exact = runner.prepared(group.truth);
    const std::vector<FeltPath> truth = felt_along(exact, paths, group.speed_mm_per_s, runner);
    for (const ForceRow& row : group.rows) {
      results.push_back(run_row(group, row, paths, truth, runner));
      results.back().truth_boundaries = boundaries_of_scene(exact.scene);
    }
  }
  if (progress) progress(1);
  return results;
}

}  // namespace palpate::plugin
