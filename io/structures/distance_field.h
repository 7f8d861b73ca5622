#pragma once

/// The signed distance from a structure's surface at any point of the patient, as read by a scene's modes.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "io/fields/field_source.h"
#include "io/structures/distance_parts.h"
#include "io/structures/mask.h"
#include "io/structures/outline_planes.h"
#include "io/structures/rigid_motion.h"

namespace palpate::io {

struct DistanceOptions {
  /// Distance from the surface up to which full detail is kept, mm: a margin, or the last node of a gate. Farther away
  /// the distance is interpolated on a coarse lattice.
  double reach_mm = 3;
  /// The scan to be felt with it. Distances are kept for all of the scan, and a structure is assumed to go on beyond
  /// its ends. Null: they are kept for the structure's box and its surroundings. Read only while the field is made.
  const Geometry* scan = nullptr;
  /// From the structure's frame of reference to the scan's.
  RigidMotion motion;
  int threads = 0;  ///< 0: all cores
};

/// A smooth field. Its surface is the smoothest one with every voxel's center on the right side (smoothest.h). The
/// distance is measured from that surface (closest_points.h), and interpolated cubically between nodes near it, so it
/// is once differentiable. Immutable.
class DistanceField {
 public:
  DistanceField(const OutlinePlanes& planes, const DistanceOptions& options);

  /// From any number of threads; in the tick: no allocation, lock or exception.
  Distance sample(const Vec3& position_mm) const noexcept;

  std::size_t bricks() const noexcept { return parts_.near.count(); }
  /// Bricks that several fields share are counted for each field.
  std::size_t memory_bytes() const noexcept { return parts_.memory_bytes(); }
  double reach_mm() const noexcept { return parts_.reach_mm; }

  explicit DistanceField(internal::DistanceParts parts) : parts_(std::move(parts)) {}
  const internal::DistanceParts& parts() const noexcept { return parts_; }

 private:
  internal::DistanceParts parts_;
};

/// The field of a mask's surface. Throws std::invalid_argument if the mask is empty.
std::shared_ptr<const DistanceField> distance_of(const Mask& mask, const DistanceOptions& options = {});

}  // namespace palpate::io
