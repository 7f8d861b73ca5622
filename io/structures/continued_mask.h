#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "io/structures/mask.h"

namespace palpate::io {

/// The position of a slice's first voxel, mm. Beyond the lattice the slices go on by the nearest step.
Vec3 slice_position(const Geometry& geometry, int k);

/// A mask with the voxels beyond its lattice. Programs crop the lattice to the structure, so the mask is empty beyond
/// it. But if the scan ends there, too, it is unknown whether the structure goes on. Then the mask is continued with
/// the shape of its end.
class ContinuedMask {
 public:
  /// Both must outlive it. `scan`: the scan that is felt with it. Null: the lattice is all that was seen.
  ContinuedMask(const Mask& mask, const Geometry* scan) : mask_(&mask), scan_(scan) {}

  const Mask& mask() const noexcept { return *mask_; }
  /// Of any voxel: 0 to Mask::full.
  std::uint8_t occupancy(const glm::ivec3& voxel) const;

 private:
  std::uint8_t beyond(const glm::ivec3& voxel) const;

  const Mask* mask_;
  const Geometry* scan_;
};

/// Enlarges the lattice by empty voxels on all six sides, as far as a field with this reach reads them: for a mask
/// without a scan.
void surround(double reach_mm, Mask& mask);

}  // namespace palpate::io
