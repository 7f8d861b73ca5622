#include "io/structures/mask_measures.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {

namespace {

/// The slabs of the slices: each reaches half of the way to its neighbors; at the ends as far as on the other side.
struct Slab {
  double thickness = 0;  // mm
  double off = 0;        // mm: its middle from the slice, along the normal
};

Slab slab_of(const Geometry& geometry, int k) {
  const double below = step_after(geometry, k - 1) / 2, above = step_after(geometry, k) / 2;
  return {below + above, (above - below) / 2};
}

}  // namespace

double step_after(const Geometry& geometry, int k) {
  const int last = static_cast<int>(geometry.slice_positions.size()) - 1;
  if (last < 1) return geometry.slice_spacing();
  const auto n = static_cast<std::size_t>(std::clamp(k, 0, last - 1));
  const Vec3 normal = glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j));
  return glm::dot(geometry.slice_positions[n + 1] - geometry.slice_positions[n], normal);
}

StructureMeasures measures_of(const Mask& mask) {
  const Geometry& geometry = mask.geometry;
  const Vec3 normal = glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j));
  StructureMeasures measures;
  std::uint64_t voxels = 0;
  double tall = 0;  // mm: of all its voxels
  Vec3 moment(0);
  Vec3 low(std::numeric_limits<double>::infinity());
  Vec3 high(-std::numeric_limits<double>::infinity());
  for (int k = 0; k < mask.size.z; ++k) {
    const Slab slab = slab_of(geometry, mask.low.z + k);
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        if (mask.occupancy[mask.offset(i, j, k)] >= Mask::half) {
          const Vec3 at = geometry.to_patient(Vec3(mask.low + glm::ivec3(i, j, k)));
          ++voxels;
          tall += slab.thickness;
          moment += slab.thickness * (at + slab.off * normal);
          low = glm::min(low, at);
          high = glm::max(high, at);
        }
      }
    }
  }
  if (voxels == 0) {
    throw DicomError(say("no-voxel-inside"));
  }
  measures.voxels = voxels;
  measures.volume_mm3 = tall * geometry.spacing_i * geometry.spacing_j;
  measures.centroid_mm = moment / tall;
  measures.box_low_mm = low;
  measures.box_high_mm = high;
  return measures;
}

}  // namespace palpate::io
