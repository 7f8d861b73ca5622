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

/// The fields that a volume can give: the value and all that is derived from it, and vectors if it holds them.
FieldSet fields_of(const Volume& volume) noexcept;

/// Value: between voxel centers by FieldOptions::value, in `Volume::unit`. Gradient: trilinear between the voxels'
/// gradients (GradientKernel), per mm. Where slices are unevenly spaced or tilted, interpolation follows the grid as it
/// is.
///
/// Low and high: of the voxels around (low_high.h), each weighted by its share and by its gradient's square.
///
/// Tube: the eigenvector of least curvature of the Hessian at the gradient's scale, trilinear between the voxels'
/// Hessians; zero within the kernel's reach of the edge or of padding.
///
/// Vector: trilinear between the voxels' vectors, in `Volume::unit`.
///
/// A worker computes gradients (with low and high, and Hessians, where they are wanted) in bricks ahead of and around
/// the point last sampled, and keeps them under a memory bound. A sample that finds its brick missing computes its cell
/// with the same kernel: it takes longer and gives the same bits.
///
/// A point is outside beyond the hull of the voxel centers, between slices if some are missing there, and if a voxel
/// that the interpolation needs is padding.
class VolumeFields : public FieldSource {
 public:
  /// Prepares only what the wanted fields need. `scale_mm` is the Gaussian's; without a Gaussian it is not read. Throws
  /// std::invalid_argument for a null volume, for fields that the scan does not have, and for a scale out of range.
  VolumeFields(std::shared_ptr<const Volume> volume, FieldSet wanted, double scale_mm,
               const FieldOptions& options = {});
  ~VolumeFields() override;

  FieldSet available() const noexcept override { return available_; }
  /// From any number of threads.
  Sample sample(const Vec3& position_mm, FieldSet wanted) const noexcept override;

  /// Fills the bricks within a distance (mm, along each axis of the grid) of a point before it returns, as far as
  /// memory allows.
  void prepare(const Vec3& position_mm, double distance_mm) const;

  /// Largest memory beyond the volume's own, bytes.
  std::size_t memory_bytes() const noexcept;

 private:
  std::shared_ptr<const Volume> volume_;
  FieldSet available_;
  GradientMethod gradient_;
  ValueMethod value_;
  Vec3 b_spline_part_;
  std::unique_ptr<const GradientKernel> kernel_;          ///< of gradients
  std::unique_ptr<const GradientKernel> hessian_kernel_;  ///< for tubes, if it is another one
  std::unique_ptr<internal::BrickCache> bricks_;
  std::unique_ptr<internal::BrickCache> tube_bricks_;

  const GradientKernel& tube_kernel() const noexcept { return hessian_kernel_ ? *hessian_kernel_ : *kernel_; }
  void sample_gradients(const internal::Cell& cell, FieldSet given, Sample& s) const noexcept;
  Vec3 sample_tube(const internal::Cell& cell) const noexcept;
};

}  // namespace palpate::io
