#pragma once

/// The fields of a scan at any point of the patient: value, gradient, vector, the direction of tubes.

#include <cstddef>
#include <memory>

#include "palpate/io/field_source.h"
#include "palpate/io/gradient.h"
#include "palpate/io/volume.h"

namespace palpate::io {

struct FieldOptions {
  std::size_t brick_bytes = std::size_t{64} << 20;  ///< bound on the memory for bricks; 0: none are kept
  bool background = true;                           ///< whether a worker fills bricks ahead
};

namespace internal {
class BrickCache;
}

/// What a volume's fields can be: the value and what is derived from it, and vectors where it holds them.
FieldSet fields_of(const Volume& volume) noexcept;

/// Value: trilinear between voxel centres, exact at them, in `Volume::unit`. Gradient: trilinear between the voxels'
/// gradients (GradientKernel), per mm. Between voxels of unevenly spaced or tilted slices the grid is followed as it
/// lies.
///
/// Low and high: of the voxels around (low_high.h), each weighted by its share and by its gradient's square; computed at
/// the sample from those gradients.
///
/// Tube: the eigenvector of least curvature of the Hessian at the gradient's scale, trilinear between the voxels'
/// Hessians; computed at the sample; zero within the kernel's reach of the edge or of padding.
///
/// Vector: trilinear between the voxels' vectors, in `Volume::unit`.
///
/// A worker computes gradients in bricks ahead of and around the point last sampled, and keeps them under a memory
/// bound. A sample that finds its brick missing computes its cell with the same kernel: it takes longer and gives the
/// same bits.
///
/// Outside: beyond the hull of the voxel centres, between slices where some are missing, and wherever a voxel that the
/// interpolation needs is padding.
class VolumeFields : public FieldSource {
 public:
  /// Prepares what the wanted fields need and no more; `scale_mm` is that of the gradient and is not read without one.
  /// Throws std::invalid_argument for no volume, for fields that a scan does not have, and for a scale out of range.
  VolumeFields(std::shared_ptr<const Volume> volume, FieldSet wanted, double scale_mm,
               const FieldOptions& options = {});
  ~VolumeFields() override;

  FieldSet available() const noexcept override { return available_; }
  /// From any number of threads.
  Sample sample(const Vec3& position_mm, FieldSet wanted) const noexcept override;

  /// Fills the bricks within a distance (mm, along each axis of the grid) of a point before it returns, as far as
  /// memory goes.
  void prepare(const Vec3& position_mm, double distance_mm) const;

  /// Largest memory beyond the volume's own, bytes.
  std::size_t memory_bytes() const noexcept;

 private:
  std::shared_ptr<const Volume> volume_;
  FieldSet available_;
  std::unique_ptr<const GradientKernel> kernel_;
  std::unique_ptr<internal::BrickCache> bricks_;
};

}  // namespace palpate::io
