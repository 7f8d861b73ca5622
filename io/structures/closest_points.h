#pragma once

/// From a field whose zero is the surface to the distance from it: each node's closest point on the surface. The field
/// itself is no distance where a structure is thin or hollow; its closest points are.

#include <glm/vec3.hpp>
#include <vector>

#include "io/structures/node_bricks.h"

namespace palpate::io {

using Vec3f = glm::vec3;

/// Where no closest point is known.
inline constexpr float nowhere = 1e9F;

/// Of every node of every brick: the closest point of the surface f = 0 (as f is interpolated, cubic.h), mm along the
/// lattice's axes from its origin. Near the surface by Newton's steps along and across the gradient (Chopp, "Some
/// improvements of the fast marching method", SIAM J. Sci. Comput. 23, 2001), farther away from neighbor to neighbor
/// (Danielsson, "Euclidean distance mapping", 1980). The same to the last bit on any number of threads.
std::vector<Vec3f> closest_points(const NodeBricks& bricks, const std::vector<float>& f, double band_mm, int threads);

/// Its two parts. The first writes the closest points of one brick's nodes, nowhere where the surface is more than two
/// nodes away: on the edges to the neighbors on the other side, and by Newton's steps.
void points_near_surface(const NodeBricks& bricks, const std::vector<float>& f, std::size_t slot, Vec3f* closest);
/// The second takes the neighbors' points over where they are closer. `unsettled`: the bricks in which a node may be
/// farther from its own point than from a neighbor's; without any of them it is all.
void spread_closest_points(const NodeBricks& bricks, double band_mm, int threads, std::vector<Vec3f>& closest,
                           std::vector<char> unsettled = {});

}  // namespace palpate::io
