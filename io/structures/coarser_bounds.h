#pragma once

/// Bounds and numbers on the lattice of every second node, and back.

#include <vector>

#include "io/structures/distance_bounds.h"

namespace palpate::io {

struct Coarser {
  DistanceBounds bounds;
  std::vector<float> f;
};

/// The lattice of every second node, without bounds where there was no brick: there `f` goes on as it was beside it.
/// `most_mm`: what no distance there exceeds.
Coarser coarser(const DistanceBounds& fine, const std::vector<float>& f, float most_mm);

/// The numbers of a coarser lattice, cubic between its nodes; as they were where it does not reach.
void refine(const NodeBricks& coarse, const std::vector<float>& numbers, const NodeBricks& fine,
            std::vector<float>& into);

}  // namespace palpate::io
