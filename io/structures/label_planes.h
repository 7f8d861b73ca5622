#pragma once

/// Turns a mask into planes of distances.

#include "io/structures/mask.h"
#include "io/structures/outline_planes.h"

namespace palpate::io {

/// The mask and the scan must outlive the planes. `reach_mm`: how far from the surface the field must be exact. Tilted
/// or unevenly spaced slices are moved to the nearest nodes, by at most a quarter of a voxel. `scan`: the scan that is
/// felt with it, or null: it says where the mask is continued beyond its lattice (continued_mask.h).
OutlinePlanes planes_of(const Mask& mask, double reach_mm, const Geometry* scan = nullptr);

}  // namespace palpate::io
