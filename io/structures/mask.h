#pragma once

/// The voxels of one structure, on the lattice that it was outlined on.

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "io/geometry.h"

namespace palpate::io {

/// Only the box around the structure is stored; everything else is outside.
struct Mask {
  /// The occupancy of a voxel that is wholly inside. A voxel with half of it or more counts as inside.
  static constexpr std::uint8_t full = 254;
  static constexpr std::uint8_t half = 127;

  Geometry geometry;                    ///< of the whole lattice
  bool has_no_thickness = false;        ///< one slice, and the file does not say how thick it is
  std::vector<int> assumed_slices;      ///< slices that the file does not hold, ascending: they count as empty slices
  glm::ivec3 low{0};                    ///< first voxel of the box
  glm::ivec3 size{0};                   ///< voxels of the box
  std::vector<std::uint8_t> occupancy;  ///< of the box, i fastest: the fraction inside, 0 to full
  /// The meaning of values of `occupancy` between 0 and full. They give the place of the edge within a voxel.
  enum class Fractions : std::uint8_t {
    none,
    probability,  ///< probability of being inside: the edge is at one half, interpolated between voxels
    occupancy     ///< fraction of the voxel that is inside
  } fractions = Fractions::none;

  std::size_t offset(int i, int j, int k) const noexcept {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i);
  }
  /// Whether a voxel of the whole lattice is inside.
  bool inside(int i, int j, int k) const noexcept {
    const int x = i - low.x, y = j - low.y, z = k - low.z;
    return x >= 0 && y >= 0 && z >= 0 && x < size.x && y < size.y && z < size.z && occupancy[offset(x, y, z)] >= half;
  }
};

}  // namespace palpate::io
