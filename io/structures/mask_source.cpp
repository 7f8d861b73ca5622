#include "io/structures/mask_source.h"

#include <glm/geometric.hpp>

#include "io/structures/continued_mask.h"
#include "io/structures/contour_planes.h"
#include "io/structures/mask_measures.h"
#include "io/structures/scan_slices.h"

namespace palpate::io {

namespace {

constexpr double beyond_mm = 20;  // of the reach: farther out a field reads nothing of the mask

}  // namespace

StructureMeasures MaskSource::measure(int number, const RigidMotion& motion, const Geometry* scan) const {
  return measures_of(moved_mask(number, motion, scan, beyond_mm));
}

std::shared_ptr<const DistanceField> MaskSource::distance(int number, const DistanceOptions& options) const {
  // Slices at any heights are moved to the nearest nodes: the fewer of them, the nearer.
  const bool is_whole = options.scan != nullptr && has_whole_steps(*options.scan);
  Mask mask = moved_mask(number, options.motion, options.scan, is_whole ? options.reach_mm + beyond_mm : 0);
  measures_of(mask);  // refuses one that is empty
  if (options.scan == nullptr) surround(options.reach_mm, mask);
  return distance_of(mask, options);
}

Mask MaskSource::moved_mask(int number, const RigidMotion& motion, const Geometry* scan, double around_mm) const {
  Mask mask = mask_of(number);
  move(motion, mask.geometry);
  if (scan != nullptr && mask.has_no_thickness) {
    const Vec3 normal = glm::normalize(glm::cross(mask.geometry.direction_i, mask.geometry.direction_j));
    mask.geometry.step = thickness_of_voxels(*scan, normal) * normal;
  }
  if (scan != nullptr) take_slices_of(*scan, around_mm, mask);
  return mask;
}

}  // namespace palpate::io
