#pragma once

/// The signed distance from a structure's surface, at any point of the patient: what a scene's modes read of it.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "io/fields/field_source.h"
#include "io/structures/mask.h"
#include "io/structures/node_bricks.h"
#include "io/structures/outline_planes.h"
#include "io/structures/rigid_motion.h"

namespace palpate::io {

struct DistanceOptions {
  /// How far from the surface the distance is kept at full detail, mm: a margin, or the last node of a gate. Farther
  /// away it is interpolated on a coarse lattice.
  double reach_mm = 3;
  /// The scan that it is felt with. Distances are kept for all of it, and a structure is assumed to go on beyond its
  /// ends. Null: they are kept for the structure's box and some way around. Read only while the field is made.
  const Geometry* scan = nullptr;
  /// Where the structure lies: from its own frame of reference to the scan's.
  RigidMotion motion;
  int threads = 0;  ///< 0: all cores
};

/// A smooth field. Its surface is the smoothest one that has every voxel's center on the right side (smoothest.h). The
/// distance is measured from that surface (closest_points.h), and is cubic between nodes near it, so once
/// differentiable. Immutable.
class DistanceField {
 public:
  DistanceField(const OutlinePlanes& planes, const DistanceOptions& options);

  /// From any number of threads; in the tick: no allocation, lock or exception.
  Distance sample(const Vec3& position_mm) const noexcept;

  std::size_t bricks() const noexcept { return near_.count(); }
  std::size_t memory_bytes() const noexcept;
  double reach_mm() const noexcept { return reach_mm_; }

 private:
  /// Whether a brick has the point: then its distance there.
  bool sample_near(const Vec3& position_mm, Distance& distance) const noexcept;
  Distance sample_far(const Vec3& position_mm) const noexcept;

  double reach_mm_;
  double blend_mm_;  ///< beyond the reach: from the bricks to the coarse lattice
  NodeBricks near_;
  glm::dmat3 to_node_;          ///< from mm to near_'s nodes
  glm::dmat3 from_node_;        ///< a slope per node to a gradient per mm
  std::vector<float> near_mm_;  ///< of each brick (8 + 3)^3 nodes: its cells need one before and two behind
  struct Coarse {
    Vec3 origin{0};
    double spacing = 1;
    glm::ivec3 size{0};
    std::vector<float> mm;
  } far_;
};

/// The field of a mask's surface. Throws std::invalid_argument where the mask is empty.
std::shared_ptr<const DistanceField> distance_of(const Mask& mask, const DistanceOptions& options = {});

}  // namespace palpate::io
