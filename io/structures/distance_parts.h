#pragma once

/// The parts of a distance field. A field and the fields that edits made of it share all unchanged bricks.

#include <glm/mat3x3.hpp>
#include <memory>
#include <vector>

#include "io/fields/field_source.h"
#include "io/structures/node_bricks.h"

namespace palpate::io::internal {

struct DistanceParts {
  static constexpr int edge = NodeBricks::edge;
  static constexpr std::ptrdiff_t wide = edge + 3;  ///< a brick's cells need one node before and two behind
  static constexpr std::size_t nodes_of_a_brick = static_cast<std::size_t>(wide) * wide * wide;
  using Page = std::shared_ptr<const std::vector<float>>;

  double reach_mm = 3;
  double blend_mm = 2;  ///< beyond the reach: from the bricks to the coarse lattice
  NodeBricks near;
  Vec3 origin{0};                   ///< of the lattice as it was first made, mm: an edit may put bricks before it
  glm::ivec3 shift{0};              ///< nodes from there back to near's own origin
  glm::dmat3 to_node{1};            ///< from mm to nodes
  glm::dmat3 from_node{1};          ///< a slope per node to a gradient per mm
  std::vector<const float*> brick;  ///< of each slot: its wide^3 nodes, mm
  std::vector<Page> pages;          ///< what `brick` points into
  /// Of a lattice along the patient's axes; a patch is a box of its nodes that differs from the rest.
  struct Coarse {
    Vec3 origin{0};
    double spacing = 1;
    glm::ivec3 size{0};
    Page mm;
    glm::ivec3 patch_low{0}, patch_size{0};  ///< nodes; without any where nothing was edited
    Page patch_mm;

    float at(int i, int j, int k) const noexcept;
  } far;

  /// The distance at the point, if a brick holds the point.
  bool sample_near(const Vec3& position_mm, Distance& distance) const noexcept;
  Distance sample_far(const Vec3& position_mm) const noexcept;
  /// From a brick if there is one, else from the coarse lattice. Not differentiable where the two meet.
  Distance sample_nearest(const Vec3& position_mm) const noexcept;
  /// How near to the surface a brick's nearest node has to be for the brick to be kept, mm.
  double kept_within_mm() const noexcept;
  std::size_t memory_bytes() const noexcept;
};

}  // namespace palpate::io::internal
