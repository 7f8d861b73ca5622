#include "io/structures/mask_measures.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {

StructureMeasures measures_of(const Mask& mask) {
  StructureMeasures measures;
  std::uint64_t voxels = 0;
  Vec3 sum(0);
  Vec3 low(std::numeric_limits<double>::infinity());
  Vec3 high(-std::numeric_limits<double>::infinity());
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        if (mask.occupancy[mask.offset(i, j, k)] >= Mask::half) {
          const Vec3 at = mask.geometry.to_patient(Vec3(mask.low + glm::ivec3(i, j, k)));
          ++voxels;
          sum += at;
          low = glm::min(low, at);
          high = glm::max(high, at);
        }
      }
    }
  }
  if (voxels == 0) {
    throw DicomError(say("no-voxel-inside"));
  }
  const Geometry& geometry = mask.geometry;
  measures.voxels = voxels;
  measures.volume_mm3 =
      static_cast<double>(voxels) * geometry.spacing_i * geometry.spacing_j * geometry.slice_spacing();
  measures.centroid_mm = sum / static_cast<double>(voxels);
  measures.box_low_mm = low;
  measures.box_high_mm = high;
  return measures;
}

}  // namespace palpate::io
