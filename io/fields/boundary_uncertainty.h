#pragma once

/// How far a boundary that is felt may be from the true one.
///
/// The boundary is the iso-surface of the interpolated value. Noise of the value moves it by noise / slope; the
/// interpolation moves it with its phase between the voxels; and the blur of voxel and interpolation moves it on a
/// curved body towards the center of curvature, by the blur's variance times the curvature, in the mean of the tangent
/// directions.
///
/// The noise is measured at the boundary itself: differences of the interpolated value at two points of the tangent
/// plane, opposite each other, in which curvature cancels, less the linear part that a slightly wrong normal leaves. So
/// filter, reconstruction kernel and interpolation are in it, and nothing is assumed of the noise but that it is alike
/// over a dozen voxels.

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
  double two_sigma_mm = 0;  ///< the true boundary is within this in 95 of 100 places
};

/// At a place on the boundary, mm. The source has to give value and gradient; `value` is the method of its values, and
/// `filter` what they were filtered with: its blur is added. Bilateral and non-local means filters are taken not to
/// blur. Outside the scan, or where the value does not rise there, two_sigma_mm is infinite. Not for the tick: some 150
/// samples.
BoundaryUncertainty uncertainty_at(const FieldSource& source, const Geometry& geometry, ValueMethod value,
                                   const Vec3& place_mm, const Filter& filter = {});

}  // namespace palpate::io
