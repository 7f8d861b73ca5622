#pragma once

#include "io/structures/continued_mask.h"

namespace palpate::io {

/// The distance of a voxel's center from the edge, mm, positive inside, from the fractions of this voxel and its
/// neighbors; of a share of a slab, from the slab's middle (which is the slice where the steps beside it are alike).
/// NaN if they do not determine it (no fraction, or no edge nearby). The index is of the whole lattice, or beyond it.
float edge_distance(const ContinuedMask& mask, int i, int j, int k);

/// The same for one box of `size` mm that a plane with this normal (inward, of any length) cuts so that `share` of the
/// box is inside. Source: the volumes below a plane of Scardovelli and Zaleski, "Analytical relations connecting linear
/// interfaces and volume fractions in rectangular grids", J. Comput. Phys. 164 (2000).
double plane_distance(const Vec3& size, const Vec3& normal, double share);

}  // namespace palpate::io
