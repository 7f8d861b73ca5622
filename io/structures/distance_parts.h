#pragma once

/// The parts of a distance field. A field and those edited from it share all unchanged bricks.

#include <glm/mat3x3.hpp>
#include <memory>
#include <vector>

#include "io/fields/field_source.h"
#include "io/structures/node_bricks.h"

namespace palpate::io::internal {

struct DistanceParts {
  static constexpr int edge = NodeBricks::edge;
  static constexpr std::ptrdiff_t wide = edge + 3;  ///< a cell in a brick needs one node before and two after
  static constexpr std::size_t nodes_of_a_brick = static_cast<std::size_t>(wide) * wide * wide;
  using Page = std::shared_ptr<const std::vector<float>>;

  double reach_mm = 3;
  double blend_mm = 2;  ///< beyond the reach: width of the blend from bricks to coarse lattice
  NodeBricks near;
  Vec3 origin{0};                   ///< of the first lattice, mm: an edit may put bricks before it
  glm::ivec3 shift{0};              ///< from that origin back to the origin of `near`, in nodes
  glm::dmat3 to_node{1};            ///< from mm to nodes
  glm::dmat3 from_node{1};          ///< a slope per node to a gradient per mm
  std::vector<const float*> brick;  ///< of each slot: its wide^3 nodes, mm
  std::vector<Page> pages;          ///< the memory that `brick` points into
  /// A lattice along the patient's axes; a patch is a box of its nodes with values of their own.
  struct Coarse {
    Vec3 origin{0};
    double spacing = 1;
    glm::ivec3 size{0};
    Page mm;
    glm::ivec3 patch_low{0}, patch_size{0};  ///< nodes; zero size if there was no edit
    Page patch_mm;

    float at(int i, int j, int k) const noexcept;
  } far;

  /// Whether a brick has the point; if so, sets its distance.
  bool sample_near(const Vec3& position_mm, Distance& distance) const noexcept;
  Distance sample_far(const Vec3& position_mm) const noexcept;
  /// From a brick if there is one, else from the coarse lattice: not once differentiable between the two.
  Distance sample_nearest(const Vec3& position_mm) const noexcept;
  /// A brick is kept if its nearest node is at most this far from the surface, mm.
  double kept_within_mm() const noexcept;
  std::size_t memory_bytes() const noexcept;
};

}  // namespace palpate::io::internal
