#pragma once

/// Boundaries within a tissue, fainter than those between tissues: a fissure in the lung, the wall of a vessel, one
/// organ against the next.
///
/// How faint one may be follows from the scan. Two sides are told apart where they differ by four standard deviations
/// of what the tissue's own values differ by anyway (noise and texture), and where their hills do not run into one,
/// which takes 3.5 bandwidths. An edge counts where its gradient is steeper than noise makes it. So a scan of one noisy
/// tissue has none.

#include <span>
#include <vector>

#include "modes/scene/scan_noise.h"
#include "modes/scene/scene.h"
#include "modes/scene/tissue_hills.h"

namespace palpate::modes::internal {

struct FaintWall {
  std::size_t within = 0;      ///< which of the tissues
  double low = 0, high = 0;    ///< typical values of its two sides, scan's unit
  Tissue low_side, high_side;  ///< their parts of the tissue; without names
  double share = 0;            ///< of the voxels at boundaries between tissues
  double noise_gradient = 0;   ///< standard deviation of a component, per mm
};

/// `range`: of the scan's values, its unit. The most frequent first.
std::vector<FaintWall> faint_walls(const io::LowHighHistogram& edges, const TissueHills& tissues,
                                   std::span<const Noise> noise, double range, double voxels_at_boundaries, bool is_ct);

/// Per mm, of a gradient at that scale: an edge less steep may be noise, or is fainter than any wall that is looked
/// for.
double least_gradient_of_walls(const ScanNoise& noise, double scale_mm);

}  // namespace palpate::modes::internal
