#pragma once

/// A user's changes to a structure's outline, as plain values. A correction is an ordered list of edits. It never
/// changes a file. All positions are in patient space (LPS), mm.

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "io/geometry.h"

namespace palpate::io {

/// The edge is moved to these points, and is unchanged farther than the reach from all of them.
struct TraceEdit {
  static constexpr double usual_reach_mm = 8;

  std::vector<Vec3> points_mm;
  std::vector<double> known_to_mm;  ///< uncertainty of each point, two standard deviations; empty: all are exact
  double reach_mm = usual_reach_mm;
  bool operator==(const TraceEdit&) const = default;
};

/// A path with a radius: a capsule from each point to the next; a ball if there is one point.
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

/// Within a ball the edge moves along its normal to the scan's own edge, if the uncertainty of that edge is smaller
/// than the move. It stays where the scan has no edge. The moves of neighboring places are smoothed: an outlier takes
/// its neighbors' move, or stays, and a move that would make a part appear or vanish is shortened.
struct ScanEdgeEdit {
  Vec3 center_mm{0};
  double radius_mm = 10;
  double most_mm = 3;  ///< the largest move
  bool operator==(const ScanEdgeEdit&) const = default;
};

/// A new structure: closed loops on parallel planes, like those of an RTSTRUCT. Can only be the first edit.
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
