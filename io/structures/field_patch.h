#pragma once

/// The bricks of a field around a change, while their distances are measured again.

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "io/structures/closest_points.h"
#include "io/structures/field_change.h"

namespace palpate::io::internal {

/// The index of a brick's node in the field's storage.
inline std::size_t stored_at(int i, int j, int k) {
  return static_cast<std::size_t>(((k + 1) * DistanceParts::wide + j + 1) * DistanceParts::wide + i + 1);
}

/// The bricks around a change: a box of the field's bricks, some of which are measured again.
struct Patch {
  const DistanceParts& old;
  const FieldChange& change;
  glm::ivec3 low{0};                               ///< of the box, in the field's bricks; may be before the first one
  NodeBricks bricks{};                             ///< those measured again; their places count from `low`
  std::vector<std::vector<std::uint32_t>> near{};  ///< by brick of the box: stretches that may lie within_mm of it
  std::vector<float> f{};                          ///< of the nodes of `bricks`
  std::vector<float> before_mm{};                  ///< likewise: the old distance
  std::vector<Vec3f> closest{}, kept{};            ///< on the new surface; `kept`: old points still on the surface
  std::vector<Vec3f> lost{};                       ///< points of the old surface that may be gone
  std::vector<float> mm{};                         ///< likewise: the new distance

  std::size_t box_at(const glm::ivec3& place) const {
    const glm::ivec3& n = bricks.lattice.bricks;
    return (static_cast<std::size_t>(place.z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(place.y)) *
               static_cast<std::size_t>(n.x) +
           static_cast<std::size_t>(place.x);
  }
  bool holds(const glm::ivec3& place) const {
    const glm::ivec3& n = bricks.lattice.bricks;
    return place.x >= 0 && place.y >= 0 && place.z >= 0 && place.x < n.x && place.y < n.y && place.z < n.z;
  }
  /// The stored nodes of the field's brick at a place of the box; null if there is none.
  const float* stored(const glm::ivec3& place) const {
    const glm::ivec3 at = low + place;
    const std::int32_t slot = old.near.slot_at(at.x, at.y, at.z);
    return slot < 0 ? nullptr : old.brick[static_cast<std::size_t>(slot)];
  }
  /// Whether the surface may change at this point (mm along the lattice's axes, from the box's corner).
  bool is_touched(const Vec3f& at) const {
    const glm::ivec3 place(glm::floor(Vec3(at) / (bricks.lattice.spacing * static_cast<double>(NodeBricks::edge))));
    if (!holds(place)) return false;
    const auto& stretches = near[box_at(place)];
    if (stretches.empty()) return false;
    const Vec3 patient = patient_of(at);
    return std::ranges::any_of(
        stretches, [&](std::uint32_t n) { return lies_within(change.where[n], patient, change.touched_mm); });
  }
  Vec3 patient_of(const Vec3f& at) const { return bricks.lattice.origin + bricks.lattice.axes * Vec3(at); }
};

/// The box of bricks within `around_mm` of the stretches, with those inside the change marked.
Patch patch_around(const DistanceParts& old, const FieldChange& change, double around_mm);

/// Evaluates the bricks within the change, and selects those to be measured again. Each of them is within `around_mm`
/// of the moved part, and within `around_mm` of a brick that the old or new surface crosses. Returns false if the
/// surface crosses none.
bool choose_bricks(Patch& patch, double around_mm, int threads, std::vector<char>& passed);

/// Measures the distance in these bricks.
void measure_anew(Patch& patch, const std::vector<char>& passed, int threads);

/// The measured distance at a place, as the stored field will give it.
double measured_at(const Patch& patch, const Vec3& place_mm);

/// Adds bumps, one for each stretch of the change, wherever the distance was measured again.
void add_to_measured(Patch& patch, const RadialBumps& bumps, int threads);

/// The field with the changed bricks in place of the old ones. Throws InvalidInput if none is left.
DistanceParts stored(const Patch& patch, int threads);

}  // namespace palpate::io::internal
