#pragma once

/// The fields of a scan at single voxels, for callers that need only a few: with the same bits as VolumeFields at a
/// voxel's center.

#include <glm/vec3.hpp>
#include <optional>

#include "io/fields/field_options.h"
#include "io/fields/low_high.h"
#include "io/volume.h"

namespace palpate::io {

/// Immutable: any number of threads may use it. The volume must outlive it.
class VoxelFields {
 public:
  /// `scale_mm`: sigma of the gradients' Gaussian.
  VoxelFields(const Volume& volume, ValueMethod value, double scale_mm);

  /// The value in `Volume::unit`; none if it cannot be sampled (in padding) or is NaN.
  std::optional<double> value(const glm::ivec3& voxel) const noexcept;
  /// The low and high of a voxel that has a value, given its gradient: patient axes, per mm.
  LowHigh low_high(const glm::ivec3& voxel, const glm::vec3& gradient) const noexcept {
    return low_high_at(volume_, voxel, Vec3(gradient), scale_mm_);
  }

 private:
  const Volume& volume_;
  ValueMethod value_;
  Vec3 b_spline_part_;
  double scale_mm_;
};

}  // namespace palpate::io
