#pragma once

#include "io/structures/mask.h"

namespace palpate::io {

/// How far a voxel's center is from the edge, mm, positive inside, as the fractions of it and of the voxels around it
/// tell; NaN where they do not (no fraction, or no edge beside it). The index is of the whole lattice; beyond the
/// lattice it goes on as it is at its edge.
float edge_distance(const Mask& mask, int i, int j, int k);

/// The same of one box of `size` mm that a plane with this normal (inward, of any length) cuts so that `share` of the
/// box is inside. Source: the volumes below a plane of Scardovelli and Zaleski, "Analytical relations connecting linear
/// interfaces and volume fractions in rectangular grids", J. Comput. Phys. 164 (2000).
double plane_distance(const Vec3& size, const Vec3& normal, double share);

}  // namespace palpate::io
