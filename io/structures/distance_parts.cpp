#include "io/structures/distance_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "io/structures/cubic.h"

namespace palpate::io::internal {

bool DistanceParts::sample_near(const Vec3& position_mm, Distance& distance) const noexcept {
  const Vec3 node = to_node * (position_mm - origin);
  const Vec3 shifted = node + Vec3(shift);
  const glm::ivec3& bricks = near.lattice.bricks;
  const glm::ivec3 last = bricks * edge;
  if (!(shifted.x >= 0 && shifted.y >= 0 && shifted.z >= 0 && shifted.x < last.x && shifted.y < last.y &&
        shifted.z < last.z)) {
    return false;
  }
  const glm::ivec3 cell(shifted);
  const glm::uvec3 place = glm::uvec3(cell) / unsigned{edge};
  const auto columns = static_cast<std::size_t>(bricks.x);
  const auto rows = static_cast<std::size_t>(bricks.y);
  const std::int32_t slot = near.slot[(place.z * rows + place.y) * columns + place.x];
  if (slot < 0) {
    return false;
  }
  const glm::ivec3 in = cell - glm::ivec3(place) * edge;
  const Vec3 t = node - Vec3(cell - shift);  // the same bits wherever the lattice begins
  const float* first =
      brick[static_cast<std::size_t>(slot)] + static_cast<std::size_t>((in.z * wide + in.y) * wide + in.x);
  const CubicSample sample = cubic_sample(first, wide, wide * wide, t);
  distance.mm = sample.value;
  distance.gradient = from_node * Vec3(sample.slope[0], sample.slope[1], sample.slope[2]);
  return true;
}

Distance DistanceParts::sample_far(const Vec3& position_mm) const noexcept {
  const double per_mm = 1 / far.spacing;
  const Vec3 node = (position_mm - far.origin) * per_mm;
  // Beyond the lattice the distance goes on as it is at its edge, plus the way there.
  const Vec3 held = glm::clamp(node, Vec3(1), Vec3(far.size) - 2.001);
  const glm::ivec3 cell(held);
  const Vec3 t = held - Vec3(cell);
  const glm::ivec3 in_patch = cell - 1 - far.patch_low;
  const bool patched = in_patch.x >= 0 && in_patch.y >= 0 && in_patch.z >= 0 && in_patch.x + 3 < far.patch_size.x &&
                       in_patch.y + 3 < far.patch_size.y && in_patch.z + 3 < far.patch_size.z;
  const glm::ivec3 at = patched ? in_patch : cell - 1;
  const glm::ivec3& size = patched ? far.patch_size : far.size;
  const std::ptrdiff_t row = size.x;
  const std::ptrdiff_t plane = row * size.y;
  const float* first = (patched ? far.patch_mm : far.mm)->data() + at.z * plane + at.y * row + at.x;
  const CubicSample sample = cubic_sample(first, row, plane, t);
  Distance distance{.mm = sample.value, .gradient = Vec3(sample.slope[0], sample.slope[1], sample.slope[2]) * per_mm};
  if (node != held) {
    const Vec3 beyond = (node - held) * far.spacing;
    const double way = glm::length(beyond);
    distance.mm -= way;
    for (int axis = 0; axis < 3; ++axis) {
      if (node[axis] != held[axis]) distance.gradient[axis] = 0;  // held: only the way there changes
    }
    distance.gradient -= beyond / way;
  }
  return distance;
}

Distance DistanceParts::sample_nearest(const Vec3& position_mm) const noexcept {
  Distance near_it;
  return sample_near(position_mm, near_it) ? near_it : sample_far(position_mm);
}

float DistanceParts::Coarse::at(int i, int j, int k) const noexcept {
  const glm::ivec3 in(glm::ivec3(i, j, k) - patch_low);
  const bool patched =
      in.x >= 0 && in.y >= 0 && in.z >= 0 && in.x < patch_size.x && in.y < patch_size.y && in.z < patch_size.z;
  const glm::ivec3 from = patched ? in : glm::ivec3(i, j, k);
  const glm::ivec3& of = patched ? patch_size : size;
  return (*(patched
                ? patch_mm
                : mm))[static_cast<std::size_t>((static_cast<std::ptrdiff_t>(from.z) * of.y + from.y) * of.x + from.x)];
}

double DistanceParts::kept_within_mm() const noexcept {
  return reach_mm + blend_mm + glm::length(near.lattice.spacing);
}

std::size_t DistanceParts::memory_bytes() const noexcept {
  std::size_t bytes = near.slot.capacity() * sizeof(std::int32_t) + near.place.capacity() * sizeof(glm::ivec3) +
                      brick.capacity() * sizeof(const float*) + far.mm->capacity() * sizeof(float);
  for (const Page& page : pages) bytes += page->capacity() * sizeof(float);
  if (far.patch_mm) bytes += far.patch_mm->capacity() * sizeof(float);
  return bytes;
}

}  // namespace palpate::io::internal
