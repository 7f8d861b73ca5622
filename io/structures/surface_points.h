#pragma once

/// Points of a surface that a signed distance gives.

#include <vector>

#include "io/structures/label_image.h"

namespace palpate::io {

struct SurfacePoint {
  Vec3 at_mm{0};
  double area_mm2 = 0;  ///< of the surface around it: the sum of all is the surface's area
};

/// Where the edges of a lattice along the patient's axes cross the surface. Along each axis a crossing stands for
/// spacing^2 / (|nx| + |ny| + |nz|) of the surface, n its normal (Cauchy and Crofton: n's parts are how many of the
/// edges cross a unit of it). The box grows until no part of the surface leaves it. `distance` need not be a distance
/// far from the surface, but has to grow there by at least 0.8 and at most 1.25 mm a mm within two lattice blocks of
/// it, and to be larger beyond.
std::vector<SurfacePoint> surface_points(const SignedDistance& distance, const StructureBox& box, double spacing_mm);

/// The same within a box that does not grow; a little around it may be looked at, too.
std::vector<SurfacePoint> surface_points_in(const SignedDistance& distance, const StructureBox& box, double spacing_mm);

/// The box with all of the surface.
StructureBox box_around(const SignedDistance& distance, StructureBox box);

/// How much of space is inside one, the other and both, by a lattice whose voxels count by parts.
struct SharedVolume {
  double first_mm3 = 0, second_mm3 = 0, both_mm3 = 0;
};
SharedVolume shared_volume(const SignedDistance& first, const SignedDistance& second, const StructureBox& box,
                           double spacing_mm);

}  // namespace palpate::io
