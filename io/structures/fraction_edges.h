#pragma once

#include "io/structures/continued_mask.h"

namespace palpate::io {

/// The distance of a voxel's center from the edge, mm, positive inside, from the fractions of this voxel and its
/// neighbors. For Fractions::occupancy the voxel is a slab that reaches half of the way to the neighboring slices, and
/// the distance is that of the slab's middle (its slice, if both steps are equal). NaN if the fractions do not
/// determine it (no fraction, or no edge nearby). The index is of the whole lattice, or beyond it.
float edge_distance(const ContinuedMask& mask, int i, int j, int k);

/// The same for one box of `size` mm that a plane with this normal (inward, of any length) cuts so that `share` of the
/// box is inside. Source: the volumes below a plane of Scardovelli and Zaleski, "Analytical relations connecting linear
/// interfaces and volume fractions in rectangular grids", J. Comput. Phys. 164 (2000).
double plane_distance(const Vec3& size, const Vec3& normal, double share);

}  // namespace palpate::io
