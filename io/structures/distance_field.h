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

namespace palpate::io {

struct DistanceOptions {
  /// Farthest from the surface that the distance is kept at full detail, mm: a margin or a gate's last node. Farther
  /// away it is interpolated on a coarse lattice.
  double reach_mm = 3;
  /// The scan that it is felt with: distances are kept for all of it, and beyond its ends a structure is taken to go
  /// on. Null: for the structure's own box and some way around it. Read while the field is made.
  const Geometry* scan = nullptr;
  int threads = 0;  ///< 0: all cores
};

/// Smooth: the surface is the smoothest that has every voxel's centre on its own side (smoothest.h), and the distance
/// is the one from that surface (closest_points.h), cubic between the nodes of bricks near it, so once differentiable.
/// Immutable.
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
