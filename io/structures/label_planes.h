#pragma once

/// Turns a mask into planes of distances.

#include "io/structures/mask.h"
#include "io/structures/outline_planes.h"

namespace palpate::io {

/// The mask must outlive the planes. `reach_mm`: how far from the surface the field must be exact. Slices
/// that are tilted or unevenly spaced are put on the nearest nodes: a quarter of a voxel away at most.
OutlinePlanes planes_of(const Mask& mask, double reach_mm);

}  // namespace palpate::io
