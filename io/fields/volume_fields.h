#pragma once

/// The fields of a scan at any point of the patient: value, gradient, vector, the direction of tubes.

#include <cstddef>
#include <memory>

#include "io/fields/field_options.h"
#include "io/fields/field_source.h"
#include "io/fields/gradient.h"
#include "io/volume.h"

namespace palpate::io {

namespace internal {
class BrickCache;
struct Cell;
}  // namespace internal

/// The fields that a volume can give: the value and everything derived from it, and vectors if it holds them.
FieldSet fields_of(const Volume& volume) noexcept;

/// Value: between voxel centers by FieldOptions::value, in `Volume::unit`. Gradient: trilinear between the voxels'
/// gradients (GradientKernel), per mm. Interpolation follows the scan's own grid, with unevenly spaced or tilted
/// slices, too.
///
/// Low and high: mean over the surrounding voxels (low_high.h), weighted by their trilinear weights and squared
/// gradients.
///
/// Tube: the eigenvector of least curvature of the Hessian at the gradient's scale, trilinear between the voxels'
/// Hessians; zero within the kernel's reach of the edge or of padding.
///
/// Vector: trilinear between the voxels' vectors, in `Volume::unit`.
///
/// A worker computes gradients (and low and high, and Hessians, if they are wanted) in bricks around and ahead of the
/// latest sample, within a memory bound. If its brick is missing, a sample computes its cell with the same kernel:
/// slower, with the same bits.
///
/// Outside: beyond the hull of the voxel centers, between slices where some are missing, and where the interpolation
/// would need a voxel that is padding.
class VolumeFields : public FieldSource {
 public:
  /// Prepares only what the wanted fields need. `scale_mm` is the Gaussian's; without a Gaussian it is ignored. Throws
  /// std::invalid_argument without a volume, for fields that a scan does not have, and for a scale out of range.
  VolumeFields(std::shared_ptr<const Volume> volume, FieldSet wanted, double scale_mm,
               const FieldOptions& options = {});
  ~VolumeFields() override;

  FieldSet available() const noexcept override { return available_; }
  /// From any number of threads.
  Sample sample(const Vec3& position_mm, FieldSet wanted) const noexcept override;

  /// Fills the bricks within a distance (mm, along each axis of the grid) of a point before it returns, as far as
  /// memory allows.
  void prepare(const Vec3& position_mm, double distance_mm) const;

  /// Largest memory use in addition to the volume's own, bytes.
  std::size_t memory_bytes() const noexcept;

 private:
  std::shared_ptr<const Volume> volume_;
  FieldSet available_;
  GradientMethod gradient_;
  ValueMethod value_;
  Vec3 b_spline_part_;
  std::unique_ptr<const GradientKernel> kernel_;          ///< of gradients
  std::unique_ptr<const GradientKernel> hessian_kernel_;  ///< of tubes, if it is a different one
  std::unique_ptr<internal::BrickCache> bricks_;
  std::unique_ptr<internal::BrickCache> tube_bricks_;

  const GradientKernel& tube_kernel() const noexcept { return hessian_kernel_ ? *hessian_kernel_ : *kernel_; }
  void sample_gradients(const internal::Cell& cell, FieldSet given, Sample& s) const noexcept;
  Vec3 sample_tube(const internal::Cell& cell) const noexcept;
};

}  // namespace palpate::io
