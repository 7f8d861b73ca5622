#pragma once

/// The force with which the modes hold the proxy at each voxel of a scan: the sum of their strengths. For pictures of a
/// whole scan: sampling voxel by voxel takes ten times as long, and gives the same bits.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "io/fields/voxel_fields.h"
#include "modes/scene/plan.h"

namespace palpate::modes {

/// The modes of a plan that hold the proxy at a boundary of the scan itself.
std::vector<const ActiveMode*> holding_modes(const Plan& plan);

/// The sum of the modes' strengths at voxels. The modes may read value, gradient, low and high. Immutable: any number
/// of threads may use it.
///
/// If no mode reads low or high, the value is the voxel's own. If one does, voxels are sampled as in a tick, but only
/// where a mode can be felt. The value is sampled where some mode's gradient factor is not zero, low and high only
/// where its value factor is not zero either.
class FeltStrength {
 public:
  /// All arguments have to outlive this object. `value` and `scale_mm` (sigma of the gradients' Gaussian) are used only
  /// with low and high.
  FeltStrength(const io::Volume& volume, std::span<const ActiveMode* const> modes, io::ValueMethod value,
               double scale_mm);

  /// N, at the voxels of a row from `first` on, with these gradients (patient axes, per mm); zero in padding.
  void at_row(const glm::ivec3& first, std::span<const glm::vec3> gradients, std::span<float> felt) const;

 private:
  struct Row;
  using Bits = std::uint64_t;  ///< of the voxels of a row; the first voxel is the lowest bit

  void add_up(const glm::ivec3& first, Row& row) const;
  void sample_and_add_up(const glm::ivec3& first, std::span<const glm::vec3> gradients, Row& row) const;
  Bits sample_values(const glm::ivec3& first, Bits wanted, Row& row) const;

  const io::Volume& volume_;
  std::span<const ActiveMode* const> modes_;
  bool reads_low_high_;
  io::VoxelFields voxels_;
};

}  // namespace palpate::modes
