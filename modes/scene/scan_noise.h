#pragma once

/// The noise of a scan's values and gradients away from boundaries: the smallest step of the values that can be told
/// from noise and texture.

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "io/fields/gradient.h"

namespace palpate::modes::internal {

struct Spread {
  double low = 0, high = 0;  ///< nearly all values lie between them; scan's unit
  double noise = 0;          ///< standard deviation of the difference between neighboring voxels, over sqrt(2)
};

struct Noise {
  double value = 0;     ///< standard deviation, scan's unit
  double gradient = 0;  ///< of one component at the kernel's scale, per mm
};

/// Noise measured at some voxels, evenly spread over the scan. They are chosen and read once, on `threads` threads (0:
/// all cores); the result does not depend on the number of threads.
class ScanNoise {
 public:
  ScanNoise(const io::Volume& volume, const io::GradientKernel& kernel, int threads);

  const Spread& spread() const noexcept { return spread_; }
  /// The noise of each range between ascending limits: limits.size() + 1 ranges, the outermost open. Values are
  /// compared at a distance of two scales of the kernel, which is that between the two sides of a boundary. So noise
  /// smeared by reconstruction counts in full, and texture counts too. Edges are too few to matter. The scan's lowest
  /// value is left out: a background clipped there has no noise.
  std::vector<Noise> between(std::span<const double> limits) const;

 private:
  Spread spread_;
  std::vector<glm::dvec2> pairs_;      // of values, two scales apart
  std::vector<glm::dvec2> gradients_;  // a value and its gradient's magnitude
};

}  // namespace palpate::modes::internal
