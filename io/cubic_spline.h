#pragma once

/// Value and gradient from one stencil: the cubic B-spline whose coefficients are the voxels themselves.
///
/// It approximates: at a voxel's centre it is 4/6 of the voxel and 1/6 of its neighbours along each axis, a blur of
/// 0.58 voxels (sigma). In return it curves smoothly, and its gradient is that of the very value it gives. Source:
/// Unser, "Splines: a perfect fit for signal and image processing", IEEE Signal Processing Magazine 16(6), 1999.

#include <glm/vec3.hpp>

#include "palpate/io/volume.h"

namespace palpate::io {

namespace internal {
struct Cell;
}

struct ValueAndGradient {
  double value = 0;  ///< in the volume's unit
  Vec3 gradient{0};  ///< per mm, patient axes
};

/// In a cell of the volume's (internal/cell.h). What the stencil lacks (beyond the edge, in padding, behind missing
/// slices) is continued straight from what there is, so linear fields stay exact to the edge where slices are even. In
/// the tick.
ValueAndGradient cubic_b_spline(const Volume& volume, const internal::Cell& cell) noexcept;

}  // namespace palpate::io
