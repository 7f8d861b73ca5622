#pragma once

/// What lies where in a CT, as far as it follows without a guess: air outside the body or inside it, the body, the
/// table.
///
/// On a grid of about 2.5 mm, each cell the mean of its voxels, air is what is less than -400 HU. It is the room's
/// where it is connected with the sides of the scan, and most of it at these sides is empty (below -900 HU, which a
/// lung that the scan cuts is not). The body is all that is thicker than 15 mm, and what lies on it. Thin things beside
/// it are the table's. Air within the body is lung where it is large and has a lung's values.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "io/volume.h"

namespace palpate::modes::internal {

enum class Region : std::uint8_t { none, room, lung, inner_air, body, table };

inline bool is_air(Region region) noexcept {
  return region == Region::room || region == Region::lung || region == Region::inner_air;
}

/// Where an edge lies: the first air on its darker side and the first solid on its brighter side; `none` where there is
/// none near.
struct Sides {
  Region low = Region::none, high = Region::none;
};

class Regions {
 public:
  /// Values in HU. On `threads` threads (0: all cores).
  explicit Regions(const io::Volume& volume, int threads = 0);

  /// Padding and all outside the scan: none.
  Region at(const glm::dvec3& index) const noexcept;
  /// Of an edge at a voxel, whose gradient (patient space) points to its brighter side; looked for within `reach_mm`.
  /// The brighter side is air too where no solid is near.
  Sides sides(const io::Geometry& geometry, const glm::ivec3& voxel, const glm::dvec3& gradient, double reach_mm) const;
  double milliliters(Region region) const noexcept;

 private:
  glm::ivec3 voxels_per_cell_{1}, cells_{0};
  double cell_ml_ = 0;
  std::vector<Region> regions_;  // x fastest
};

}  // namespace palpate::modes::internal
