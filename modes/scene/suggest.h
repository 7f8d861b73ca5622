#pragma once

/// A scene proposed from a scan: its tissues, the boundaries between them, and their transfer functions.
///
/// The voxels at boundaries are counted by the values on their two sides (io/fields/low_high.h). A tissue is a peak of
/// the smoothed counts of low and high values together. A boundary is a pair of tissues with enough voxels between
/// them. So a tissue counts by its surface and not by its volume: a thin skull is found as surely as a large volume of
/// air. A tissue without a boundary is not found.

#include <memory>
#include <string>
#include <vector>

#include "io/fields/histogram.h"
#include "io/progress.h"
#include "modes/scene/scene.h"
#include "modes/scene/site.h"

namespace palpate::modes {

/// A boundary that was found: modes[mode] of the scene.
struct FoundBoundary {
  std::size_t mode = 0;           ///< crossed from the lower to the higher values
  std::size_t way_back = 0;       ///< the mode for the other way; switched off
  std::size_t low = 0, high = 0;  ///< its two tissues in the scene
  /// The value at which it is felt: half-way between the two typical values, or for bone nearer to the softer tissue;
  /// scan's unit.
  double middle = 0;
  double share = 0;         ///< of all voxels at boundaries between tissues
  std::string within = {};  ///< for a fainter wall within a tissue: that tissue
  SiteCounts sites = {};    ///< CT only: where its edges lie
};

struct Suggestion {
  Scene scene;
  /// For each of the scene's tissues, scan's unit: first those in ascending order, then the sides of fainter walls.
  std::vector<double> typical;
  std::vector<FoundBoundary> boundaries;  ///< the most frequent first, in the order of the scene's modes
  io::LowHighHistogram edges;             ///< the counts in which they were found
};

/// Tissues of a CT are named by their HU (air, lung or foam, fat, soft tissue, bone, metal), others by their rank.
/// Every boundary becomes a surface with a name (boundary_names.h), a switch, and its tissue's color (tissue_colors.h).
/// If two surfaces have one tissue, the second gets another color that the color-blind can tell from the rest. A
/// surface's strength rises with the gradient and begins at the boundary's middle, so that it is felt there. The way
/// back, from the higher to the lower values, is a second surface of the same color, switched off, since a hand comes
/// from outside. A scan without boundaries gives a scene without modes. Throws io::Cancelled.
Suggestion suggest(const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress = {}, int threads = 0);

}  // namespace palpate::modes
