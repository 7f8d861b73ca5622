#pragma once

/// The smoothest surface with every voxel's center on its own side. Two steps alternate. One finds, of all fields f
/// that keep the signs and equal the distance farther away, the one with the least integral of (Laplacian f)^2. The
/// other finds the distance from the surface of f. It converges to the distance with the least bending: a ball stays a
/// ball. Sources: Lempitsky, "Surface extraction from binary volumes with higher-order smoothness", CVPR 2010, for the
/// signs as bounds. Using the distance instead of bounds far away keeps the surface from flattening.

#include <vector>

#include "io/structures/distance_bounds.h"

namespace palpate::io {

struct SmoothestOptions {
  /// The number of coarser lattices on which it begins, each with every second node: so many that the coarsest has no
  /// nodes between the slices of an outline, where nothing is known.
  int coarser = 0;
  int coarse_rounds = 8;  ///< on each of them
  int rounds = 6;         ///< repetitions with a new distance from the surface, on the finest
  /// Accelerated projected gradient steps in a round (Beck and Teboulle 2009, restarted as by O'Donoghue and Candes
  /// 2015).
  int steps = 60;
  int threads = 0;
};

/// f at every node of every brick, mm: its zero is the surface. The same to the last bit on any number of threads.
std::vector<float> smoothest(const DistanceBounds& bounds, const SmoothestOptions& options = {});

}  // namespace palpate::io
