#include "io/structures/continued_mask.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace palpate::io {
namespace {

std::uint8_t in_box(const Mask& mask, const glm::ivec3& voxel) {
  const glm::ivec3 at = voxel - mask.low;
  const bool held =
      at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < mask.size.x && at.y < mask.size.y && at.z < mask.size.z;
  return held ? mask.occupancy[mask.offset(at.x, at.y, at.z)] : 0;
}

}  // namespace

Vec3 slice_position(const Geometry& geometry, int k) {
  return geometry.to_patient({0, 0, k});
}

std::uint8_t ContinuedMask::occupancy(const glm::ivec3& voxel) const {
  const glm::ivec3 held = glm::clamp(voxel, glm::ivec3(0), mask_->geometry.dimensions - 1);
  if (held == voxel || scan_ == nullptr) return in_box(*mask_, held);
  return beyond(voxel);
}

std::uint8_t ContinuedMask::beyond(const glm::ivec3& voxel) const {
  const Geometry& geometry = mask_->geometry;
  const Vec3 at = slice_position(geometry, voxel.z) + voxel.x * geometry.spacing_i * geometry.direction_i +
                  voxel.y * geometry.spacing_j * geometry.direction_j;
  constexpr double rounding = 1e-3;  // of a voxel
  const Vec3 index = scan_->to_index(at);
  const Vec3 seen = glm::clamp(index, Vec3(rounding - 0.5), Vec3(scan_->dimensions) - 0.5 - rounding);
  if (seen == index) return 0;
  // The outermost voxels of both end together, or within a voxel: else the scan has seen what lies between.
  const Vec3 nearest = geometry.to_index(scan_->to_patient(seen));
  const Vec3 last(geometry.dimensions - 1);
  const Vec3 held = glm::clamp(nearest, Vec3(0), last);
  const Vec3 apart = glm::abs(nearest - held);
  if (std::max({apart.x, apart.y, apart.z}) >= 1) return 0;
  return in_box(*mask_, glm::ivec3(glm::round(held)));
}

void surround(double reach_mm, Mask& mask) {
  constexpr double most = 64;
  Geometry& geometry = mask.geometry;
  const Vec3 voxel(geometry.spacing_i, geometry.spacing_j, std::max(geometry.slice_spacing(), 1e-3));
  const glm::ivec3 count(glm::clamp(glm::ceil((reach_mm + 20) / voxel), Vec3(1), Vec3(most)));
  std::vector<Vec3> slices;
  const Vec3 corner =
      count.x * geometry.spacing_i * geometry.direction_i + count.y * geometry.spacing_j * geometry.direction_j;
  for (int k = -count.z; k < geometry.dimensions.z + count.z; ++k) {
    slices.push_back(slice_position(geometry, k) - corner);
  }
  geometry.slice_positions = std::move(slices);
  geometry.dimensions += 2 * count;
  mask.low += count;
}

}  // namespace palpate::io
