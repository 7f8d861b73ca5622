#pragma once

/// Restricts bounds and numbers to the lattice of every second node, and interpolates numbers back.

#include <vector>

#include "io/structures/distance_bounds.h"

namespace palpate::io {

struct Coarser {
  DistanceBounds bounds;
  std::vector<float> f;
};

/// The lattice of every second node. Where there was no brick, `f` is that of the nearest node, and the bounds are
/// -most_mm and most_mm: no distance is larger.
Coarser coarser(const DistanceBounds& fine, const std::vector<float>& f, float most_mm);

/// Interpolates the numbers of a coarser lattice (cubic). `into` keeps its numbers where the coarser lattice has none.
void refine(const NodeBricks& coarse, const std::vector<float>& numbers, const NodeBricks& fine,
            std::vector<float>& into);

}  // namespace palpate::io
