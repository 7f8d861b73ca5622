#pragma once

/// Value and gradient from one stencil of 64 voxels: a cubic spline whose coefficients are the voxels themselves.
///
/// Along an axis of the grid it is a mixture of the B-spline, which blurs by a standard deviation of 0.58 voxels, and
/// the Catmull-Rom spline, which interpolates the voxels and does not blur. The B-spline's part is 1 along the axis
/// with the finest voxels. Along the other axes it is chosen so that the blur has the same width in mm. So thick slices
/// are not blurred further: that would shift a curved boundary. All mixtures are exact on linear fields and smooth, and
/// the gradient is that of the returned value. Source: D. P. Mitchell and A. N. Netravali, "Reconstruction filters in
/// computer graphics", SIGGRAPH 1988: the kernels with B + 2 C = 1, whose variance is B / 3 voxels squared.

#include <glm/vec3.hpp>

#include "io/volume.h"

namespace palpate::io {

namespace internal {
struct Cell;
}

struct ValueAndGradient {
  double value = 0;  ///< in the volume's unit
  Vec3 gradient{0};  ///< per mm, patient axes
};

/// The B-spline's part (B) along each axis of a grid.
Vec3 b_spline_part(const Geometry& geometry) noexcept;

/// In a cell of the volume (cell.h); part: the result of b_spline_part() for its geometry. Missing voxels of the
/// stencil (beyond the edge, in padding, behind missing slices) are extrapolated linearly, so linear fields stay exact
/// to the edge. Linear fields are also exact between uneven slices; there the gradient is that of the value to first
/// order. If all 64 voxels are equal, so is the value, to the last bit. In the tick.
ValueAndGradient cubic_spline(const Volume& volume, const internal::Cell& cell, const Vec3& part) noexcept;

/// The same value, without its gradient. In the tick.
double cubic_spline_value(const Volume& volume, const internal::Cell& cell, const Vec3& part) noexcept;

}  // namespace palpate::io
