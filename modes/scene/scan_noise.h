#pragma once

/// What a scan's values and gradients do where there is no boundary: how small a step of the values can still be told
/// from noise and texture.

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "io/fields/gradient.h"

namespace palpate::modes::internal {

struct Spread {
  double low = 0, high = 0;  ///< nearly all values lie between; scan's unit
  double noise = 0;          ///< standard deviation from a voxel to its neighbor, over sqrt(2)
};

struct Noise {
  double value = 0;     ///< standard deviation, scan's unit
  double gradient = 0;  ///< of one component at the kernel's scale, per mm
};

/// What is measured at some voxels, evenly spread over the scan. The voxels are chosen and read once, on `threads`
/// threads (0: all cores); what is measured does not depend on them.
class ScanNoise {
 public:
  ScanNoise(const io::Volume& volume, const io::GradientKernel& kernel, int threads);

  const Spread& spread() const noexcept { return spread_; }
  /// Of each of the ranges between ascending limits; limits.size() + 1 of them, and the outermost are open. The values
  /// are compared over two scales of the kernel, as the two sides of a boundary are: so noise that a reconstruction has
  /// smeared counts in full, and texture counts too. Edges are too few to matter. The scan's lowest value is passed
  /// over: a background that was cut off there has no noise of its own.
  std::vector<Noise> between(std::span<const double> limits) const;

 private:
  Spread spread_;
  std::vector<glm::dvec2> pairs_;      // of values, two scales apart
  std::vector<glm::dvec2> gradients_;  // a value and its gradient's magnitude
};

}  // namespace palpate::modes::internal
