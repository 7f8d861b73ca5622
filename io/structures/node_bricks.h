#pragma once

/// The lattice that a structure's distance is computed on: straight, at right angles, near the voxels' own spacing
/// along each axis, so that every voxel's centre lies on one of its nodes; kept in bricks, near the surface only.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "io/geometry.h"

namespace palpate::io {

struct NodeLattice {
  Vec3 origin{0};        ///< mm, of node 0, 0, 0
  glm::dmat3 axes{1};    ///< columns: unit, at right angles
  Vec3 spacing{1};       ///< mm
  glm::ivec3 bricks{0};  ///< how many along each axis

  Vec3 position(const Vec3& node) const noexcept { return origin + axes * (node * spacing); }
  Vec3 node_of(const Vec3& position_mm) const noexcept {
    return (glm::transpose(axes) * (position_mm - origin)) / spacing;
  }
};

/// Which bricks there are.
struct NodeBricks {
  static constexpr int edge = 8;  ///< nodes along each axis of a brick
  static constexpr std::size_t nodes = 512;
  static constexpr std::int32_t outside = -1;  ///< in `slot`: no brick, for all of it lies outside
  static constexpr std::int32_t inside = -2;   ///< likewise, inside

  NodeLattice lattice;
  std::vector<std::int32_t> slot;  ///< by brick, i fastest
  std::vector<glm::ivec3> place;   ///< of the brick in each slot

  std::size_t count() const noexcept { return place.size(); }
  std::int32_t slot_at(int x, int y, int z) const noexcept {
    const glm::ivec3& n = lattice.bricks;
    if (x < 0 || y < 0 || z < 0 || x >= n.x || y >= n.y || z >= n.z) {
      return outside;
    }
    return slot[(static_cast<std::size_t>(z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(y)) *
                    static_cast<std::size_t>(n.x) +
                static_cast<std::size_t>(x)];
  }
  /// Of the nodes' numbers, one array for each slot.
  static constexpr std::size_t at(int i, int j, int k) noexcept {
    constexpr auto wide = static_cast<std::size_t>(edge);
    return (static_cast<std::size_t>(k) * wide + static_cast<std::size_t>(j)) * wide + static_cast<std::size_t>(i);
  }
};

/// A brick's numbers with those of its neighbours up to `margin` nodes around it: (8 + 2 margin)^3, i fastest. Where
/// there is no brick: `missing`.
template <int margin, typename Number>
void gather(const NodeBricks& bricks, std::span<const Number> numbers, std::size_t slot, const Number& missing,
            Number* into) noexcept {
  constexpr std::ptrdiff_t wide = NodeBricks::edge + 2 * margin;
  const glm::ivec3 place = bricks.place[slot];
  for (int dz = -1; dz <= 1; ++dz) {
    const int z0 = dz < 0 ? -margin : dz * NodeBricks::edge;
    const int z1 = dz < 0 ? 0 : (dz == 0 ? NodeBricks::edge : NodeBricks::edge + margin);
    for (int dy = -1; dy <= 1; ++dy) {
      const int y0 = dy < 0 ? -margin : dy * NodeBricks::edge;
      const int y1 = dy < 0 ? 0 : (dy == 0 ? NodeBricks::edge : NodeBricks::edge + margin);
      for (int dx = -1; dx <= 1; ++dx) {
        const int x0 = dx < 0 ? -margin : dx * NodeBricks::edge;
        const int x1 = dx < 0 ? 0 : (dx == 0 ? NodeBricks::edge : NodeBricks::edge + margin);
        const std::int32_t from = bricks.slot_at(place.x + dx, place.y + dy, place.z + dz);
        const Number* source = from < 0 ? nullptr : numbers.data() + static_cast<std::size_t>(from) * NodeBricks::nodes;
        for (int z = z0; z < z1; ++z) {
          for (int y = y0; y < y1; ++y) {
            Number* row = into + ((z + margin) * wide + y + margin) * wide + margin;
            for (int x = x0; x < x1; ++x) {
              row[x] = source == nullptr ? missing
                                         : source[NodeBricks::at(x - dx * NodeBricks::edge, y - dy * NodeBricks::edge,
                                                                 z - dz * NodeBricks::edge)];
            }
          }
        }
      }
    }
  }
}

}  // namespace palpate::io
