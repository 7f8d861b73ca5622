#pragma once

/// The surface of a structure from its distance, or of a value in a scan, as triangles. Source: "naive surface nets",
/// after S. F. F. Gibson, "Constrained elastic surface nets", MICCAI 1998. Here the distance moves each vertex of a
/// structure onto the surface.

#include <functional>

#include "io/bounding_box.h"
#include "io/volume.h"
#include "plugin/openigtlink/surface.h"

namespace palpate::plugin::igtl {

/// Signed distance, mm, positive inside, and its gradient.
struct SurfaceDistance {
  double mm = 0;
  glm::dvec3 gradient{0};
};

/// In the frame of the box, with cells of 1 mm, or of 2, 4 ... mm if there would be more than 60 000 of them. Cells
/// whose center is farther from the surface than their corners are skipped.
Surface isosurface(const std::function<SurfaceDistance(const glm::dvec3&)>& distance, const io::Box& box);

/// In patient space: where the scan's values, interpolated between voxels (or every few voxels), cross this value.
/// Normals point to lower values. The number of cells has the same limit; there is no surface beside padding, or where
/// slices are missing.
Surface isosurface(const io::Volume& volume, double value);

}  // namespace palpate::plugin::igtl
