#pragma once

/// Points on the surface of a signed distance.

#include <vector>

#include "io/structures/label_image.h"

namespace palpate::io {

struct SurfacePoint {
  Vec3 at_mm{0};
  double area_mm2 = 0;  ///< of the surface around it: the sum of all is the surface's area
};

/// The crossings of the surface with the edges of a lattice along the patient's axes. A crossing represents an area of
/// spacing^2 / (|nx| + |ny| + |nz|), where n is its normal (Cauchy and Crofton: the components of n are the numbers of
/// edges that cross a unit of area). The box grows until it contains the whole surface. `distance` may be inexact, but
/// within two lattice blocks of the surface it must grow by 0.8 to 1.25 mm per mm, and be larger beyond.
std::vector<SurfacePoint> surface_points(const SignedDistance& distance, const StructureBox& box, double spacing_mm);

/// The same within a box that does not grow. Distances slightly outside the box may be read, too.
std::vector<SurfacePoint> surface_points_in(const SignedDistance& distance, const StructureBox& box, double spacing_mm);

/// The box around the whole surface.
StructureBox box_around(const SignedDistance& distance, StructureBox box);

/// The volume inside one, the other and both, on a lattice with fractions of voxels.
struct SharedVolume {
  double first_mm3 = 0, second_mm3 = 0, both_mm3 = 0;
};
SharedVolume shared_volume(const SignedDistance& first, const SignedDistance& second, const StructureBox& box,
                           double spacing_mm);

}  // namespace palpate::io
