#pragma once

/// Boundaries within a tissue, fainter than those between tissues: a fissure in the lung, the wall of a vessel, one
/// organ against the next.
///
/// The scan decides how faint a wall may be. Its two sides have to differ by four standard deviations of the tissue's
/// own values (noise and texture). Their hills have to be at least 3.5 bandwidths apart. An edge counts if its gradient
/// is steeper than noise. So a scan of one noisy tissue has no walls.

#include <span>
#include <vector>

#include "modes/scene/scan_noise.h"
#include "modes/scene/scene.h"
#include "modes/scene/tissue_hills.h"

namespace palpate::modes::internal {

struct FaintWall {
  std::size_t within = 0;      ///< index of the tissue
  double low = 0, high = 0;    ///< typical values of its two sides, scan's unit
  Tissue low_side, high_side;  ///< the two parts of the tissue; without names
  double share = 0;            ///< voxels at this wall, as a fraction of those at boundaries between tissues
  double noise_gradient = 0;   ///< standard deviation of a component, per mm
};

/// `range`: of the scan's values, in its unit. The most frequent wall comes first.
std::vector<FaintWall> faint_walls(const io::LowHighHistogram& edges, const TissueHills& tissues,
                                   std::span<const Noise> noise, double range, double voxels_at_boundaries, bool is_ct);

/// Per mm, at scale_mm: a less steep edge may be noise, or is fainter than any wall that is found.
double least_gradient_of_walls(const ScanNoise& noise, double scale_mm);

}  // namespace palpate::modes::internal
