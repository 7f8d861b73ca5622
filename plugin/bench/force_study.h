#pragma once

/// Rows of `palpate-bench forces`: each a scene on data, felt along the same paths as the truth of its group.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/progress.h"
#include "plugin/bench/force_errors.h"
#include "plugin/bench/force_paths.h"

namespace palpate::plugin {

/// Prepares a scene on its data. Asks now and then whether to go on, and throws io::Cancelled if not.
using MakeFelt = std::function<FeltScene(const io::Progress&)>;

/// One row. To add one: append it to a group in force_phantom.cpp or force_labels.cpp.
struct ForceRow {
  std::string name;
  MakeFelt make;  ///< called when the row is run, so that one is in memory at a time
};

struct ForceGroup {
  std::string name;
  std::string against;  ///< what the truth is, for people
  PathWorld world;
  MakeFelt truth;
  double speed_mm_per_s = 50;
  /// How far a place is from the nearest true boundary, mm; empty if nobody knows.
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
  double us_a_tick = 0;  ///< of the fastest 32 paths: what else the machine did is not the row's
  double ready_s = 0;    ///< to prepare the row: filter, fields, suggestion
};

/// All but the times depends on the groups and the seed alone, whatever the number of threads. Throws io::Cancelled.
std::vector<ForceRowResult> compare_forces(const std::vector<ForceGroup>& groups, const ForceOptions& options,
                                           const io::Progress& progress = {});

}  // namespace palpate::plugin
