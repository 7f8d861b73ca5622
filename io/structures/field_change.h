#pragma once

/// The change of a distance field by one edit, and the new field.

#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <span>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/radial_bumps.h"

namespace palpate::io::internal {

/// A piece of a path; a point if both ends are the same.
struct Stretch {
  Vec3 from{0}, to{0};
};
double distance_to(const Stretch& stretch, const Vec3& place) noexcept;
/// Whether a place is nearer than so many mm to the stretch.
inline bool lies_within(const Stretch& stretch, const Vec3& place, double mm) noexcept {
  if (stretch.from != stretch.to) return distance_to(stretch, place) < mm;
  const Vec3 way = place - stretch.from;
  return glm::dot(way, way) < mm * mm;
}

struct FieldChange {
  std::vector<Stretch> where;
  double touched_mm = 0;  ///< farther than this from all stretches the surface does not change
  double within_mm = 0;   ///< `after` is called within this distance of a stretch; >= touched_mm
  /// A number whose zero is the new surface. It equals `before` farther than within_mm from all stretches. `near`: the
  /// stretches that may be nearer.
  std::function<double(const Vec3& at, double before, std::span<const std::uint32_t> near)> after;
  /// If `after` is `before` plus a sum of bumps, one for each stretch in their order, the bumps may be given here. They
  /// are then evaluated at the nodes of bricks instead of `after`.
  std::shared_ptr<const RadialBumps> bumps;
};

struct Patch;
/// May change the measured distance before it is stored.
using Settle = std::function<void(Patch&)>;

/// The field of the new surface. The distance is measured anew wherever the nearest point of the surface, before or
/// after, lies within touched_mm of a stretch; everywhere else it keeps its bits. Farther than 20 mm from the changed
/// surface the coarse lattice gradually keeps what it had. Returns `before` where nothing changed. Throws InvalidInput
/// if nothing would be left of the structure, or the change is too large.
std::shared_ptr<const DistanceField> changed(const std::shared_ptr<const DistanceField>& before,
                                             const FieldChange& change, int threads, const Settle& settle = {});

}  // namespace palpate::io::internal
