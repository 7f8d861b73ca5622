#pragma once

/// The values on both sides of a boundary, which tell the two tissues that it separates. Value and gradient alone do
/// not: between air and bone the value passes that of every soft tissue. Source: Sereda et al., "Visualization of
/// boundaries in volumetric data sets using LH histograms", IEEE TVCG 12(2), 2006. That paper
/// follows the gradient until it vanishes. Here the steepest part of the profile is found first: a smoothed gradient is
/// already large beside a sharp edge, and the values of the two sides of that edge are wanted.

#include <glm/vec3.hpp>

#include "io/volume.h"

namespace palpate::io {

struct LowHigh {
  float low = 0;   ///< the volume's unit; on the side with lower values, against the gradient
  float high = 0;  ///< on the other side; never less than low
};

/// At a voxel, given its gradient (patient axes, per mm) at a scale (sigma, mm). The steepest rise along the straight
/// line through the voxel is found, weighted by nearness, and followed both ways until it is a tenth as steep. Without
/// a rise (in a flat neighborhood, beside padding) both values are the voxel's own. May be called in a tick. Every
/// caller gets the same bits.
LowHigh low_high_at(const Volume& volume, const glm::ivec3& voxel, const Vec3& gradient, double scale_mm) noexcept;

}  // namespace palpate::io
