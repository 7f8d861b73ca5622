#pragma once

/// The lattice on which a structure's distance is computed. It is straight and at right angles, with a spacing near the
/// voxels', so that every voxel's center is a node. It is kept in bricks, near the surface only.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <limits>
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

/// The bricks that exist.
struct NodeBricks {
  static constexpr int edge = 8;  ///< nodes along each axis of a brick
  static constexpr std::size_t nodes = 512;
  static constexpr std::int32_t outside = -1;  ///< in `slot`: no brick, since all of its nodes lie outside
  static constexpr std::int32_t inside = -2;   ///< in `slot`: no brick, since all of its nodes lie inside

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
  /// The index of a node in the array of its brick's numbers.
  static constexpr std::size_t at(int i, int j, int k) noexcept {
    constexpr auto wide = static_cast<std::size_t>(edge);
    return (static_cast<std::size_t>(k) * wide + static_cast<std::size_t>(j)) * wide + static_cast<std::size_t>(i);
  }
};

inline constexpr int brick_edge = NodeBricks::edge;                        ///< nodes along each axis
inline constexpr std::size_t brick_nodes = NodeBricks::nodes;              ///< in all
inline constexpr float no_node = std::numeric_limits<float>::quiet_NaN();  ///< a number that no brick holds

/// Copies `count` numbers, or writes `missing` where `from` is null. Inline, since a call would cost more than such a
/// short copy.
template <int count, typename Number>
inline void put_row(const Number* from, const Number& missing, Number* into) noexcept {
  if (from == nullptr) {
    for (int n = 0; n < count; ++n) into[n] = missing;
  } else {
    for (int n = 0; n < count; ++n) into[n] = from[n];
  }
}

/// A brick's numbers with those of its neighbors up to `margin` nodes around it: (8 + 2 margin)^3, i fastest. `missing`
/// is used where there is no brick.
template <int margin, typename Number>
void gather(const NodeBricks& bricks, std::span<const Number> numbers, std::size_t slot, const Number& missing,
            Number* into) noexcept {
  constexpr int edge = NodeBricks::edge;
  constexpr std::ptrdiff_t wide = edge + 2 * margin;
  const glm::ivec3 place = bricks.place[slot];
  const auto first = [](int d) { return d < 0 ? -margin : d * edge; };
  const auto end = [](int d) { return d < 0 ? 0 : (d == 0 ? edge : edge + margin); };
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      std::array<const Number*, 3> bases{};  // of the bricks before, at and behind
      for (int dx = -1; dx <= 1; ++dx) {
        const std::int32_t from = bricks.slot_at(place.x + dx, place.y + dy, place.z + dz);
        if (from < 0) continue;
        bases.data()[dx + 1] = numbers.data() + static_cast<std::size_t>(from) * NodeBricks::nodes;
      }
      const auto [before, at, behind] = bases;
      for (int z = first(dz); z < end(dz); ++z) {
        for (int y = first(dy); y < end(dy); ++y) {
          const std::size_t row = NodeBricks::at(0, y - dy * edge, z - dz * edge);
          Number* const to = into + ((z + margin) * wide + y + margin) * wide;
          put_row<margin>(before == nullptr ? nullptr : before + row + (edge - margin), missing, to);
          put_row<edge>(at == nullptr ? nullptr : at + row, missing, to + margin);
          put_row<margin>(behind == nullptr ? nullptr : behind + row, missing, to + margin + edge);
        }
      }
    }
  }
}

}  // namespace palpate::io
