#pragma once

/// Computes the distance from a surface, from each node's closest point on it. The surface is the zero of a field. The
/// field itself is not a distance where a structure is thin or hollow.

#include <glm/vec3.hpp>
#include <vector>

#include "io/structures/node_bricks.h"

namespace palpate::io {

using Vec3f = glm::vec3;

/// The closest point is not known.
inline constexpr float nowhere = 1e9F;

/// The closest point of the surface f = 0 (f interpolated as in cubic.h) to every node of every brick, mm along the
/// lattice's axes from its origin. Near the surface by Newton steps along and across the gradient (Chopp, "Some
/// improvements of the fast marching method", SIAM J. Sci. Comput. 23, 2001), farther away from neighbor to neighbor
/// (Danielsson, "Euclidean distance mapping", 1980). The same to the last bit on any number of threads.
std::vector<Vec3f> closest_points(const NodeBricks& bricks, const std::vector<float>& f, double band_mm, int threads);

/// The first part of closest_points(): the closest points of one brick's nodes, found on the edges to neighbors on the
/// other side and by Newton steps; `nowhere` if the surface is more than two nodes away.
void points_near_surface(const NodeBricks& bricks, const std::vector<float>& f, std::size_t slot, Vec3f* closest);
/// The second part: takes over a neighbor's point if it is closer. `unsettled`: bricks with nodes that may be farther
/// from their own point than from a neighbor's; if empty, all bricks.
void spread_closest_points(const NodeBricks& bricks, double band_mm, int threads, std::vector<Vec3f>& closest,
                           std::vector<char> unsettled = {});

}  // namespace palpate::io
