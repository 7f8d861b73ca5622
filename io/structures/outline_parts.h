#pragma once

/// The parts of a structure that do not touch each other, and the holes in it.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/outline_places.h"

namespace palpate::io {

struct OutlinePart {
  bool is_hole = false;   ///< outside of the structure, and wholly enclosed by it
  double volume_mm3 = 0;  ///< of the nodes' cells in it
  Vec3 deepest_mm{0};     ///< the place farthest from the surface, and how far it is from there
  double depth_mm = 0;
};

/// All parts, by volume, the largest first. Nodes are joined along the lattice's axes. `of_place`, if asked
/// for, tells for each of `places` the part whose surface it lies on; a hole's surface is its own, not the structure's
/// around it.
std::vector<OutlinePart> outline_parts(const DistanceField& field, const std::vector<OutlinePlace>& places = {},
                                       std::vector<std::size_t>* of_place = nullptr);

}  // namespace palpate::io
