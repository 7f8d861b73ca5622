#pragma once

/// The distance between a felt boundary and the true one.
///
/// The boundary is the iso-surface of the interpolated value. Four effects move it. Noise moves it by noise / slope.
/// Interpolation moves it, depending on its place between the voxels. The blur of voxel and interpolation moves a
/// curved boundary towards the center of curvature, by the blur's variance times the mean curvature of the tangent
/// directions. An iso-value other than the mean of the two sides puts it beside the true boundary: blur keeps only the
/// place of the mean.
///
/// The values of the two sides are read where the value stops rising and falling along the normal. A smooth gradient
/// may be felt some millimeters away from the boundary, where the value hardly rises; the distance then includes the
/// way to the place where it does rise. A tissue thinner than the blur does not reach its value. Its true value is
/// estimated from its width, as far as possible; the rest is uncertainty.
///
/// The noise is measured at the boundary itself, from differences of the interpolated value at two opposite points of
/// the tangent plane. Curvature cancels in them, and the linear part of a slightly wrong normal is subtracted. So the
/// noise includes the effects of filter, reconstruction kernel and interpolation. The only assumption is that it is
/// uniform over a dozen voxels.

#include "io/fields/field_options.h"
#include "io/fields/field_source.h"
#include "io/filter.h"
#include "io/geometry.h"

namespace palpate::io {

struct BoundaryUncertainty {
  double noise = 0;        ///< standard deviation of the interpolated value, the scan's unit
  double slope = 0;        ///< of the interpolated value across the boundary, unit per mm
  double noise_mm = 0;     ///< one standard deviation of the boundary's place through noise
  double sampling_mm = 0;  ///< one standard deviation of the same through interpolation
  double curvature_mm =
      0;  ///< shift of the boundary on a curved body through blur; positive: into a denser body that is convex
  double level_mm = 0;      ///< distance from the middle of its two sides; positive: on the denser side
  double two_sigma_mm = 0;  ///< the true boundary is within this at 95 of 100 places
};

/// At a place on the boundary, mm. The source must give value and gradient. `value` is the method of its values, and
/// `filter` its filter, whose blur is added. Bilateral and non-local means filters count as free of blur. two_sigma_mm
/// is infinite outside the scan, where the value does not rise, where a thin tissue does not reach the middle, and if
/// it would be more than 8 mm. Not for the tick: it takes about 600 samples.
BoundaryUncertainty uncertainty_at(const FieldSource& source, const Geometry& geometry, ValueMethod value,
                                   const Vec3& place_mm, const Filter& filter = {});

}  // namespace palpate::io
