#pragma once

/// Computes the distance from a surface that is the zero of a field: the closest point on the surface for each node.
/// Where a structure is thin or hollow the field itself is not a distance.

#include <glm/vec3.hpp>
#include <vector>

#include "io/structures/node_bricks.h"

namespace palpate::io {

using Vec3f = glm::vec3;

/// Stands for an unknown closest point.
inline constexpr float nowhere = 1e9F;

/// Of every node of every brick: the closest point of the surface f = 0 (as f is interpolated, cubic.h), mm along the
/// lattice's axes from its origin. Near the surface by Newton's steps along and across the gradient (Chopp, "Some
/// improvements of the fast marching method", SIAM J. Sci. Comput. 23, 2001), farther away from neighbor to neighbor
/// (Danielsson, "Euclidean distance mapping", 1980). The same to the last bit on any number of threads.
std::vector<Vec3f> closest_points(const NodeBricks& bricks, const std::vector<float>& f, double band_mm, int threads);

/// The two parts of closest_points(). The first writes the closest points of one brick's nodes, from the edges that
/// cross the surface and by Newton's steps; `nowhere` if the surface is more than two nodes away.
void points_near_surface(const NodeBricks& bricks, const std::vector<float>& f, std::size_t slot, Vec3f* closest);
/// The second replaces a node's point by a neighbor's if that is closer. `unsettled`: the bricks in which this may
/// happen; empty: all bricks.
void spread_closest_points(const NodeBricks& bricks, double band_mm, int threads, std::vector<Vec3f>& closest,
                           std::vector<char> unsettled = {});

}  // namespace palpate::io
