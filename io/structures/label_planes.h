#pragma once

/// Turns a mask into planes of distances.

#include "io/structures/mask.h"
#include "io/structures/outline_planes.h"

namespace palpate::io {

/// The mask must outlive the planes. `reach_mm`: how far from the surface the field must be exact. Tilted or unevenly
/// spaced slices are moved to the nearest nodes, by at most a quarter of a voxel.
OutlinePlanes planes_of(const Mask& mask, double reach_mm);

}  // namespace palpate::io
