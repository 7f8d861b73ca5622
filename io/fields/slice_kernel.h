#pragma once

/// The Gaussian weights between any two slices, for any slice geometry: even, uneven or tilted.
///
/// Offsets are in mm along the geometry's own basis (direction_i, direction_j, normal). A tilted slice's neighbors are
/// displaced in its plane, so the in-plane weights are centered there: the Gaussian stays round in the patient.

#include <glm/mat3x3.hpp>
#include <vector>

#include "io/geometry.h"

namespace palpate::io::internal {

inline constexpr int largest_radius = 64;  ///< voxels
inline constexpr double cut_off = 3.2;     ///< sigmas

/// One voxel of a row (or column): its offset in voxels, and its weight times its offset in mm to the power 0, 1, 2.
struct Tap {
  int offset = 0;
  float weight[3] = {0, 0, 0};
};

/// Ordered from the middle outwards, alternating sides (the negative first). If the middle is a voxel, the two sides
/// have equal weights, so their values are added or subtracted before weighting. This halves the products, and on even
/// data the two sides cancel to exactly 0.
using Taps = std::vector<Tap>;

/// The contribution of slice `slice` to another slice.
struct Contribution {
  int slice = 0;
  float weight = 0;
  float offset[3] = {0, 0, 0};  ///< mm: this slice's voxel (i, j) from the other's voxel (i, j)
  int taps = 0;                 ///< index into SliceKernel::taps_i and taps_j
  /// Whether the next contribution has the same distance on the other side, and the same weight: the two are added
  /// first.
  bool paired = false;
};

struct SliceKernel {
  std::vector<std::vector<Contribution>> of_slice;  ///< by slice, from itself outwards
  std::vector<Taps> taps_i;
  std::vector<Taps> taps_j;
  /// Whether all contributions share the first taps, so that the in-plane sums of a slice serve every other slice. The
  /// taps are then symmetric, too.
  bool straight = true;
  glm::ivec3 radius{0};   ///< largest offset along each axis
  glm::dmat3 to_patient;  ///< gradient along the basis -> gradient in patient space (inverse transpose of the basis)
};

/// Throws std::invalid_argument for a scale that is not above 0 or reaches over more than largest_radius voxels.
SliceKernel make_slice_kernel(const Geometry& geometry, double scale_mm);

}  // namespace palpate::io::internal
