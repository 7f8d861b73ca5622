#pragma once

/// What modes hold at the voxels of a scan: the sum of their strengths. For pictures of a whole scan, where sampling
/// each voxel for itself takes ten times as long; the results are the same to the last bit.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "io/fields/gradient.h"
#include "modes/scene/plan.h"

namespace palpate::modes {

/// The modes of a plan that hold the proxy at a boundary of the scan itself.
std::vector<const ActiveMode*> holding_modes(const Plan& plan);

/// The sum of the modes' strengths at voxels. The modes may read value and gradient. Immutable: any number of threads
/// may use it.
class FeltStrength {
 public:
  /// All of them have to outlive it.
  FeltStrength(const io::Volume& volume, std::span<const ActiveMode* const> modes) : volume_(volume), modes_(modes) {}

  /// N, at the voxels from `first` on along a row, whose gradients (patient axes, per mm) are given; zero in padding.
  void at_row(const glm::ivec3& first, std::span<const glm::vec3> gradients, std::span<float> felt) const;

 private:
  const io::Volume& volume_;
  std::span<const ActiveMode* const> modes_;
};

}  // namespace palpate::modes
