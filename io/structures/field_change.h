#pragma once

/// How one edit changes a distance field, and the resulting field.

#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <span>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/radial_bumps.h"

namespace palpate::io::internal {

/// A segment of a path; a point if both ends are the same.
struct Stretch {
  Vec3 from{0}, to{0};
};
double distance_to(const Stretch& stretch, const Vec3& place) noexcept;
/// Whether a position is nearer to a segment than `mm`.
inline bool lies_within(const Stretch& stretch, const Vec3& place, double mm) noexcept {
  if (stretch.from != stretch.to) return distance_to(stretch, place) < mm;
  const Vec3 way = place - stretch.from;
  return glm::dot(way, way) < mm * mm;
}

struct FieldChange {
  std::vector<Stretch> where;
  double touched_mm = 0;  ///< farther than this from all stretches the surface is unchanged
  double within_mm = 0;   ///< `after` is called up to this distance from a stretch; at least touched_mm
  /// The function whose zero is the new surface; farther than within_mm from all stretches it is `before`. `near`: the
  /// stretches that may be nearer than within_mm.
  std::function<double(const Vec3& at, double before, std::span<const std::uint32_t> near)> after;
  /// If `after` is `before` plus a sum, the sum may be given as bumps: one for each stretch, in their order. At the
  /// nodes of bricks these are used instead of `after`.
  std::shared_ptr<const RadialBumps> bumps;
};

struct Patch;
/// May change the measured distance before it is stored.
using Settle = std::function<void(Patch&)>;

/// The field of the new surface. The distance is measured again where the nearest point of the old or new surface is
/// within touched_mm of a stretch; everywhere else it stays the same to the last bit. Farther than 20 mm from the
/// changed surface the coarse lattice gradually returns to its old values. Returns `before` if nothing changed. Throws
/// InvalidInput if nothing would be left of the structure, or the change is too large.
std::shared_ptr<const DistanceField> changed(const std::shared_ptr<const DistanceField>& before,
                                             const FieldChange& change, int threads, const Settle& settle = {});

}  // namespace palpate::io::internal
