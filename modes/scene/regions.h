#pragma once

/// The regions of a CT that can be found without a guess: air outside the body or inside it, the body, the table.
///
/// On a grid of about 2.5 mm, each cell is the mean of its voxels, and air is below -400 HU. Air is the room's if it is
/// connected with the sides of the scan and most of it at these sides is below -900 HU (a lung cut by the scan is not).
/// The body is everything thicker than 15 mm, and what lies on it. Thin things beside it are the table. Air within the
/// body is lung if it is large and has a lung's values.

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

/// The regions beside an edge: the first air on its darker side and the first solid on its brighter side; `none` if
/// there is none near.
struct Sides {
  Region low = Region::none, high = Region::none;
};

class Regions {
 public:
  /// Values in HU. Uses `threads` threads (0: all cores).
  explicit Regions(const io::Volume& volume, int threads = 0);

  /// `none` in padding and outside the scan.
  Region at(const glm::dvec3& index) const noexcept;
  /// The sides of an edge at a voxel, searched within `reach_mm`. The gradient (patient space) points to the brighter
  /// side, which is air too if no solid is near.
  Sides sides(const io::Geometry& geometry, const glm::ivec3& voxel, const glm::dvec3& gradient, double reach_mm) const;
  double milliliters(Region region) const noexcept;

 private:
  glm::ivec3 voxels_per_cell_{1}, cells_{0};
  double cell_ml_ = 0;
  std::vector<Region> regions_;  // x fastest
};

}  // namespace palpate::modes::internal
