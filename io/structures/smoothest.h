#pragma once

/// The smoothest field within bounds: of all fields f with lower <= f <= upper at every node the one with the least
/// integral of (Laplacian f)^2. A voxel's side is one of the bounds, so the surface f = 0 parts what is labelled from
/// what is not, and is otherwise as smooth as it can be. Source: Lempitsky, "Surface extraction from binary volumes
/// with higher-order smoothness", CVPR 2010.

#include <vector>

#include "io/structures/distance_bounds.h"

namespace palpate::io {

/// How long it is sought: accelerated projected gradient steps (Beck and Teboulle 2009, restarted as by O'Donoghue and
/// Candes 2015) on the coarser lattices, each half as fine as the next, and on the finest.
struct SmoothestOptions {
  int levels = 1;
  int coarse_steps = 60;
  int fine_steps = 150;
  int threads = 0;
};

/// f at every node of every brick, mm. The same to the last bit on any number of threads.
std::vector<float> smoothest(const DistanceBounds& bounds, const SmoothestOptions& options = {});

}  // namespace palpate::io
