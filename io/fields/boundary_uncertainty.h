#pragma once

/// How far a boundary that is felt may be from the true one.
///
/// The boundary is the iso-surface of the interpolated value. Four things move it. Noise of the value moves it by
/// noise / slope. The interpolation moves it with its phase between the voxels. The blur of voxel and interpolation
/// moves it on a curved body towards the center of curvature, by the blur's variance times the mean curvature of the
/// tangent directions. And a boundary that is felt at another value than the middle of its two sides lies beside the
/// true one: blur leaves the middle alone where it is. The values of the two sides are those at which the value stops
/// rising and falling along the normal. Where the value hardly rises, a smooth gradient has reached a boundary some
/// millimeters away, and the distance is that to the place where the value does rise. A tissue that is thinner than the
/// blur does not reach its value: what it would have reached follows from its width, as far as that tells; the rest is
/// uncertainty.
///
/// The noise is measured at the boundary itself, from differences of the interpolated value at two opposite points of
/// the tangent plane. Curvature cancels in them; the linear part that a slightly wrong normal leaves is subtracted. So
/// the noise holds the effects of filter, reconstruction kernel and interpolation. It is assumed to be alike over a
/// dozen voxels, and nothing else.

#include "io/fields/field_options.h"
#include "io/fields/field_source.h"
#include "io/filter.h"
#include "io/geometry.h"

namespace palpate::io {

struct BoundaryUncertainty {
  double noise = 0;        ///< standard deviation of the interpolated value, the scan's unit
  double slope = 0;        ///< of the interpolated value across the boundary, unit per mm
  double noise_mm = 0;     ///< one standard deviation of the boundary's place through noise
  double sampling_mm = 0;  ///< one standard deviation through the phase between voxels
  double curvature_mm =
      0;  ///< shift of the boundary on a curved body through blur; positive: into a denser body that is convex
  double level_mm = 0;      ///< of the place beyond the middle of its two sides; positive: on the denser side
  double two_sigma_mm = 0;  ///< the true boundary is within this in 95 of 100 places
};

/// At a place on the boundary, mm. The source must give value and gradient. `value` is the method of its values, and
/// `filter` is what they were filtered with: its blur is added. Bilateral and non-local means filters count as free of
/// blur. Outside the scan, where the value does not rise, where a thin tissue does not reach the
/// middle, and where it would be more than 8 mm, two_sigma_mm is infinite. Not for the tick: it takes some 600 samples.
BoundaryUncertainty uncertainty_at(const FieldSource& source, const Geometry& geometry, ValueMethod value,
                                   const Vec3& place_mm, const Filter& filter = {});

}  // namespace palpate::io
