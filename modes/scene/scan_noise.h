#pragma once

/// What a scan's values and gradients do where there is no boundary: how small a step of the values can still be told
/// from noise and texture.

#include <span>
#include <vector>

#include "io/fields/gradient.h"

namespace palpate::modes::internal {

struct Spread {
  double low = 0, high = 0;  ///< nearly all values lie between; scan's unit
  double noise = 0;          ///< standard deviation from a voxel to its neighbor, over sqrt(2)
};
Spread spread_of(const io::Volume& volume);

struct Noise {
  double value = 0;     ///< standard deviation, scan's unit
  double gradient = 0;  ///< of one component at the kernel's scale, per mm
};

/// Of each of the ranges between ascending limits; limits.size() + 1 of them, and the outermost are open. The values
/// are compared over two scales of the kernel, as the two sides of a boundary are: so noise that a reconstruction has
/// smeared counts in full, and texture counts too. Edges are too few to matter. The scan's lowest value is passed over:
/// a background that was cut off there has no noise of its own.
std::vector<Noise> noise_between(const io::Volume& volume, const io::GradientKernel& kernel,
                                 std::span<const double> limits, double lowest);

}  // namespace palpate::modes::internal
