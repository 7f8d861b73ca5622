#pragma once

/// Differences between the six neighbors of a voxel, in patient space: the sharpest gradient of a scan, and the
/// noisiest.

#include <array>
#include <vector>

#include "io/fields/gradient.h"
#include "io/fields/straight_block.h"
#include "io/volume.h"

namespace palpate::io::internal {

/// Exact on linear fields on any grid. On tilted slices the neighbors' displacement is corrected; if the two neighbors'
/// distances differ, the nearer has more weight (the parabola through the three). One-sided at the edge, beside padding
/// and beside missing slices; 0 along an axis without neighbors, and in padding.
class CentralDifferences {
 public:
  CentralDifferences() = default;
  /// slope: the volume's rescale slope.
  CentralDifferences(const Geometry& geometry, double slope);

  void at_block(const Volume& volume, const Block& block, const GradientTarget& target) const noexcept;

  /// Weights of the differences: per step along i and j, and between slices.
  struct Weights {
    glm::vec3 along_i{0};
    glm::vec3 along_j{0};
    glm::vec3 up{0};
    glm::vec3 down{0};
  };
  enum Sides : unsigned { neither = 0, above = 1, below = 2, both = 3 };

 private:
  template <typename Stored>
  void run(const Volume& volume, const std::vector<Stored>& voxels, const Block& block,
           const GradientTarget& target) const noexcept;

  std::vector<std::array<Weights, 4>> of_slice_;  ///< by Sides
  std::vector<Sides> sides_;                      ///< whether there are neighboring slices to compare with
};

}  // namespace palpate::io::internal
