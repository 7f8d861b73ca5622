#pragma once

/// Whether touch helps a simulated hand to cut apart two structures whose outlines were merged: a ball in a socket,
/// with a gap of 3 mm between them that the outline bridges on one side. The hand goes along the gap's middle, as it is
/// seen on a screen, with *Remove* as wide as the gap: once without forces, and once between the edges that it feels.

#include <vector>

namespace palpate::plugin {

struct MergedResult {
  std::vector<double> before_mm, after_mm;  ///< how far the outline is from the two true edges, where it bridged them
  double path_mm = 0, points = 0;           ///< of a hand
};
MergedResult study_merged(int hands, bool felt);

}  // namespace palpate::plugin
