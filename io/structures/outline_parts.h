#pragma once

/// The parts of a structure that do not touch each other, and the holes in it.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/outline_places.h"

namespace palpate::io {

struct OutlinePart {
  bool is_hole = false;   ///< outside the structure, and wholly enclosed by it
  double volume_mm3 = 0;  ///< of the nodes' cells in it
  Vec3 deepest_mm{0};     ///< the place farthest from the surface, and its distance
  double depth_mm = 0;
};

/// All parts, by volume, the largest first. Nodes are connected along the lattice's axes. `of_place`, if given, gets
/// for each of `places` the part with that surface; the surface of a hole belongs to the hole, not to the structure
/// around it.
std::vector<OutlinePart> outline_parts(const DistanceField& field, const std::vector<OutlinePlace>& places = {},
                                       std::vector<std::size_t>* of_place = nullptr);

}  // namespace palpate::io
