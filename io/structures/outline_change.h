#pragma once

/// The size of the change that edits made to an outline, to be shown to the user.

#include <optional>
#include <span>

#include "io/structures/distance_field.h"
#include "io/structures/edit.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// A box that contains all places at which these edits can move the edge; none if there are none.
std::optional<StructureBox> box_of_edits(std::span<const Edit> edits);

struct OutlineChange {
  double added_mm3 = 0, removed_mm3 = 0;
  double largest_mm = 0;  ///< largest distance from a point of one surface to the other surface
  Vec3 largest_at_mm{0};  ///< the point with that distance
};

/// Compares within a box, on a lattice of 1 mm, or a coarser one if the box is large. Both fields must reach as far as
/// the edge has moved; beyond their reach the largest change is read from their coarse lattice.
OutlineChange outline_change(const DistanceField& before, const DistanceField& after, const StructureBox& box);

}  // namespace palpate::io
