#pragma once

/// A scene proposed from a scan: its tissues, the boundaries between them, and their transfer functions.
///
/// The voxels at boundaries are counted by the values on both sides (io/low_high.h). A tissue is a hill of the counts
/// of low and high together, smoothed, that stands out of its valleys; a boundary is a pair of tissues that enough of
/// the voxels lie between. So a tissue counts by its surface and not by its volume, as it does for a hand; a thin skull
/// and a large air are found alike, and what has no boundary is no tissue.

#include <memory>
#include <vector>

#include "io/fields/histogram.h"
#include "io/progress.h"
#include "modes/scene/scene.h"

namespace palpate::modes {

/// A boundary as it was found: modes[mode] of the scene.
struct FoundBoundary {
  std::size_t mode = 0;           ///< crossed from the lower to the higher values
  std::size_t way_back = 0;       ///< the mode that is crossed the other way; switched off
  std::size_t low = 0, high = 0;  ///< its two tissues in the scene
  double middle = 0;  ///< where it is felt: half-way from the one's typical value to the other's, or nearer to the
                      ///< softer tissue of bone; scan's unit
  double share = 0;   ///< of all voxels at boundaries
};

struct Suggestion {
  Scene scene;
  std::vector<double> typical;            ///< value of each of the scene's tissues: the top of its hill, scan's unit
  std::vector<FoundBoundary> boundaries;  ///< most frequent first, as the scene's modes
  io::LowHighHistogram edges;             ///< what they were found in
};

/// For CT tissues are named by their HU (air, lung or foam, fat, soft tissue, bone, metal), else by their rank. Every
/// boundary is a surface with a name, a color that the color-blind can tell from the others, and a switch; its
/// strength rises with the gradient and sets in at the boundary's middle, so that this is where it is felt. The way
/// back, from the higher to the lower values, is a surface of its own in the same color, switched off: a hand that
/// comes from outside meets what it enters. The scene has no mode for a scan without boundaries. Throws io::Cancelled.
Suggestion suggest(const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress = {}, int threads = 0);

}  // namespace palpate::modes
