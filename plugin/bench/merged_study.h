#pragma once

/// Whether touch helps a simulated hand to separate two structures whose outlines were merged: a ball in a socket, with
/// a gap of 3 mm that the outline bridges on one side. The hand follows the middle of the gap on a screen, with
/// *Remove* as wide as the gap: once without forces, and once between the edges that it feels.

#include <vector>

namespace palpate::plugin {

struct MergedResult {
  std::vector<double> before_mm, after_mm;  ///< distance of the outline from the two true edges, at the bridge
  double path_mm = 0, points = 0;           ///< of a hand's path
};
MergedResult study_merged(int hands, bool felt);

}  // namespace palpate::plugin
