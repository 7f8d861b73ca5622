#pragma once

/// The gradient of a scan at a scale: derivative of Gaussian, in patient space (LPS), per mm.
///
/// At a voxel it is the slope of the plane that best fits the surrounding voxels, each weighted by a Gaussian of its
/// distance in mm (cut off at 3.2 sigma along each axis). On a complete neighborhood this equals the derivative of
/// Gaussian. At the edge of the volume, beside padding, and between uneven or tilted slices it stays exact on linear
/// fields. Voxels outside do not count, so the end of the data is no boundary. Source: Knutsson and Westin, "Normalized
/// and differential convolution", CVPR 1993.
///
/// Central differences between neighboring voxels are the alternative: sharper and noisier.
///
/// The same kernel computes the whole volume, a brick and a single sample, with the same bits: every sum is taken in
/// the same order, in single precision, without fused operations. OpenCV's filters do not allow this, because their
/// rounding differs between the vectorized part and the end of a row, and between processors.

#include <array>
#include <cstddef>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "io/progress.h"
#include "io/volume.h"

namespace palpate::io {

/// The largest accepted scale of a derivative of Gaussian on this grid, mm.
double largest_gradient_scale_mm(const Geometry& geometry) noexcept;

/// max(1.5 mm, 2 in-plane voxels, 0.6 slice spacing), but at most the largest scale; mm.
double default_gradient_scale_mm(const Geometry& geometry) noexcept;

/// A box of voxels.
struct Block {
  glm::ivec3 first{0};
  glm::ivec3 size{0};

  std::size_t voxels() const noexcept {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }
};

/// Reads the volume, and itself stores little more than weights. Immutable: any number of threads may use it.
class GradientKernel {
 public:
  struct CentralDifferences {};
  /// Throws std::invalid_argument for a scale that is not above 0 or reaches over more than 64 voxels, and
  /// std::logic_error without a volume.
  GradientKernel(std::shared_ptr<const Volume> volume, double scale_mm);
  /// Central differences. Throws std::logic_error without a volume.
  GradientKernel(std::shared_ptr<const Volume> volume, CentralDifferences);
  ~GradientKernel();
  GradientKernel(const GradientKernel&) = delete;
  GradientKernel& operator=(const GradientKernel&) = delete;

  /// Sigma of the Gaussian; for central differences, half the largest distance that they span.
  double scale_mm() const noexcept;
  /// Half the kernel's width along each axis, voxels.
  glm::ivec3 radius() const noexcept;

  /// The gradients of the at most eight voxels of a cell: writes size.x * size.y * size.z of them, i fastest. May be
  /// called in the tick. At most 2 voxels along each axis, all of them within the volume.
  void at_cell(const Block& cell, std::span<glm::vec3> gradients) const noexcept;
  /// The second derivatives xx, xy, yy, xz, yz, zz of a voxel's stored value in patient space, per mm^2, without the
  /// rescale slope. NaN if the neighborhood is incomplete, because second derivatives there would be guesses.
  using Hessian = std::array<float, 6>;
  /// The Hessians of the same Gaussian at a cell's voxels; not for central differences. May be called in the tick.
  void hessians_at_cell(const Block& cell, std::span<Hessian> hessians) const noexcept;
  /// The Hessians of any block; allocates.
  void hessians_at_block(const Block& block, std::span<Hessian> hessians) const;
  /// The gradients of any block within the volume; allocates.
  void at_block(const Block& block, std::span<glm::vec3> gradients) const;
  /// Computes the whole volume block by block, on `threads` threads (0: all cores), in any order. `use` gets every
  /// voxel once; several threads may call it at a time. Throws Cancelled, and any exception of `use`.
  void for_each_block(const std::function<void(const Block&, std::span<const glm::vec3>)>& use,
                      const Progress& progress = {}, int threads = 0) const;
  /// The whole volume's gradients: 12 bytes a voxel. Throws Cancelled.
  std::vector<glm::vec3> whole(const Progress& progress = {}, int threads = 0) const;
  /// The same into the caller's memory: one for each voxel, i fastest. Fresh memory is best: it is mapped in large
  /// pages, and all threads share the first writes.
  void whole_into(std::span<glm::vec3> gradients, const Progress& progress = {}, int threads = 0) const;

 private:
  struct Weights;
  std::unique_ptr<const Weights> weights_;
};

}  // namespace palpate::io
