#pragma once

/// How near and how far the surface can be of every node near it, from what an outline says: a point that is known to
/// be inside has no more of the outside around it than to the nearest point that is known to be outside, and so on.
/// What obeys these bounds has every voxel on its side.

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
