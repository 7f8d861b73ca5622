#pragma once

/// The edits of a structure's outline, as plain values. A correction is an ordered list of edits. It never
/// changes a file. All places are in patient space (LPS), mm.

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "io/geometry.h"

namespace palpate::io {

/// The edge goes through these points, and is as before farther than the reach from all of them.
struct TraceEdit {
  static constexpr double usual_reach_mm = 8;

  std::vector<Vec3> points_mm;
  std::vector<double> known_to_mm;  ///< two standard deviations of each point; or empty: all are exact
  double reach_mm = usual_reach_mm;
  bool operator==(const TraceEdit&) const = default;
};

/// A path with a radius: one capsule from each point to the next, or a ball.
struct Tube {
  std::vector<Vec3> path_mm;
  double radius_mm = 3;
  bool operator==(const Tube&) const = default;
};
struct AddEdit {
  Tube tube;  ///< joined with the structure
  bool operator==(const AddEdit&) const = default;
};
struct RemoveEdit {
  Tube tube;  ///< cut out of the structure
  bool operator==(const RemoveEdit&) const = default;
};

/// Within a ball the edge moves along its normal to the scan's edge, if that edge's uncertainty is smaller than the way
/// there. It stays where the scan has no edge. The ways of neighboring places are smoothed: a place that differs from
/// its neighbors moves as they do, or stays, and a way that would make a part appear or vanish is shortened.
struct ScanEdgeEdit {
  Vec3 center_mm{0};
  double radius_mm = 10;
  double most_mm = 3;  ///< the largest way
  bool operator==(const ScanEdgeEdit&) const = default;
};

/// A new structure: closed loops on parallel planes, as those of an RTSTRUCT. It can only be the first edit.
struct ContoursEdit {
  std::vector<std::vector<Vec3>> loops_mm;
  bool operator==(const ContoursEdit&) const = default;
};

using Edit = std::variant<TraceEdit, AddEdit, RemoveEdit, ScanEdgeEdit, ContoursEdit>;

/// "trace", "add", "remove", "scan_edge", "contours".
const char* name_of(const Edit& edit) noexcept;

/// Limits of an edit.
namespace edit_limits {
inline constexpr std::size_t most_edits = 10'000;
inline constexpr std::size_t most_points = 100'000;     ///< of one edit
inline constexpr double least_mm = 0.2, most_mm = 100;  ///< of a reach or radius
}  // namespace edit_limits

}  // namespace palpate::io
