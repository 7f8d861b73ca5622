#pragma once

/// Updates the coarse lattice of a field after an edit.

#include <functional>
#include <span>
#include <vector>

#include "io/structures/closest_points.h"
#include "io/structures/distance_parts.h"
#include "io/structures/field_change.h"

namespace palpate::io::internal {

struct CoarseChange {
  const NodeLattice& lattice;  ///< of the points, mm along its axes from its origin
  std::span<const Stretch> where;
  double within_mm = 0;
  std::vector<Vec3f> lost{};                                     ///< points of the old surface that may be gone
  std::vector<Vec3f> surface{};                                  ///< points of the new surface
  std::function<double(const Vec3& at, double before)> after{};  ///< its sign is that of the new field
};

/// Distances are true within 20 mm of the change, and blend into the previous ones within 12 mm more. `parts` must hold
/// the new bricks, and the lattice from before the edit.
void change_coarse(const CoarseChange& change, int threads, DistanceParts& parts);

}  // namespace palpate::io::internal
