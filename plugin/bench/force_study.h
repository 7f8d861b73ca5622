#pragma once

/// Rows of `palpate-bench forces`: each is a scene on data, felt along the same paths as the truth of its group.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/progress.h"
#include "plugin/bench/force_errors.h"
#include "plugin/bench/force_paths.h"

namespace palpate::plugin {

/// Prepares a scene on its data. Throws io::Cancelled if its progress callback returns false.
using MakeFelt = std::function<FeltScene(const io::Progress&)>;

/// One row. To add one: append it to a group in force_phantom.cpp or force_labels.cpp.
struct ForceRow {
  std::string name;
  MakeFelt make;  ///< called when the row runs, so that only one row is in memory at a time
};

struct ForceGroup {
  std::string name;
  std::string against;  ///< the truth, in words
  PathWorld world;
  MakeFelt truth;
  double speed_mm_per_s = 50;
  /// The distance of a place from the nearest true boundary, mm; empty if unknown.
  std::function<double(const glm::dvec3&)> off_mm;
  std::vector<ForceRow> rows;
};

struct ForceOptions {
  std::size_t paths_a_row = 1000;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
};

struct ForceRowResult {
  std::string group, name;
  std::vector<std::string> boundaries;        ///< of the row's scene
  std::vector<std::string> truth_boundaries;  ///< of the truth's
  std::size_t paths = 0;
  ForceErrors errors;
  double us_a_tick = 0;  ///< of the fastest 32 paths, to exclude the load of other programs
  double ready_s = 0;    ///< time to prepare the row: filter, fields, suggestion
};

/// Everything except the times depends only on the groups and the seed, for any number of threads. Throws
/// io::Cancelled.
std::vector<ForceRowResult> compare_forces(const std::vector<ForceGroup>& groups, const ForceOptions& options,
                                           const io::Progress& progress = {});

}  // namespace palpate::plugin
