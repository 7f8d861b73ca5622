#pragma once

/// The least and the largest possible distance of each node near the surface, from an outline. A node inside is at most
/// as far from the surface as from the nearest point that is known to be outside, and vice versa. A field within these
/// bounds has every voxel on its own side of the surface.

#include <vector>

#include "io/structures/node_bricks.h"
#include "io/structures/outline_planes.h"

namespace palpate::io {

/// Signed distances, mm, positive inside; of the nodes of each brick.
struct DistanceBounds {
  NodeBricks bricks;
  std::vector<float> lower;
  std::vector<float> upper;
};

/// `threads` 0: all cores; the result is the same on any number.
DistanceBounds bounds_of(const OutlinePlanes& planes, int threads);

}  // namespace palpate::io
