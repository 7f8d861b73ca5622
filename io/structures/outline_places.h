#pragma once

/// Places on a structure's surface, evenly spread.

#include <vector>

#include "io/structures/distance_field.h"

namespace palpate::io {

struct OutlinePlace {
  Vec3 place_mm{0};
  Vec3 inward{0};       ///< unit
  double area_mm2 = 0;  ///< of the surface around it: the areas of all places add up to the surface's
};

/// About one place for each square of `spacing_mm`. Two walls closer than that have places of their own.
/// Areas come from the edges of a lattice: an edge along axis k that crosses the surface counts h_i h_j |n_k|.
std::vector<OutlinePlace> outline_places(const DistanceField& field, double spacing_mm);

}  // namespace palpate::io
