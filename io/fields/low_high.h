#pragma once

/// The values on both sides of a boundary, which tell the two tissues that it separates. Value and gradient cannot
/// tell: on the way from air to bone every soft tissue's value is passed. Source: Sereda et al., "Visualization of
/// boundaries in volumetric data sets using LH histograms", IEEE TVCG 12(2), 2006; theirs follows the gradient until it
/// fades, ours finds first which step of the profile the gradient comes from, so that beside a sharp edge, where a
/// gradient at a scale is large already, it is that edge's two sides that are found.

#include <glm/vec3.hpp>

#include "io/volume.h"

namespace palpate::io {

struct LowHigh {
  float low = 0;   ///< the volume's unit; on the side that the gradient points away from
  float high = 0;  ///< on the side that it points to; never less than low
};

/// At a voxel, given its gradient (patient axes, per mm) at a scale (sigma, mm): along the straight line through it the
/// steepest rise is found, each weighted by its nearness, and followed both ways until it is a tenth as steep. Both
/// values are the voxel's own if there is no rise: in a flat neighborhood, or beside padding. In the tick; the same
/// bits wherever it is called from.
LowHigh low_high_at(const Volume& volume, const glm::ivec3& voxel, const Vec3& gradient, double scale_mm) noexcept;

}  // namespace palpate::io
