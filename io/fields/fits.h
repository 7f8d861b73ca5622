#pragma once

/// The plane fits of a scan that do not depend on its voxels: of complete neighborhoods, and of those that the volume's
/// edge cuts off.

#include <array>
#include <cstddef>
#include <vector>

#include "io/fields/moments.h"
#include "io/fields/plane_fit.h"
#include "io/fields/slice_kernel.h"

namespace palpate::io::internal {

class Fits {
 public:
  Fits() = default;
  /// to_patient: gradient along the kernel's basis -> patient space, rescale slope included.
  Fits(const glm::ivec3& dimensions, const SliceKernel& kernel, double scale_mm, const glm::dmat3& to_patient);

  double scale_mm() const noexcept { return scale_mm_; }
  /// Gradient along the kernel's basis -> patient space, rescale slope included.
  const glm::dmat3& to_patient() const noexcept { return to_patient_; }

  using Sums = std::array<float, space_sums(2)>;

  /// The fit of a complete neighborhood, by slice.
  const PlaneFit& whole(int k) const noexcept { return whole_[static_cast<std::size_t>(k)]; }
  /// The sums of that fit's weights.
  const Sums& whole_sums(int k) const noexcept { return whole_sums_[static_cast<std::size_t>(k)]; }

  /// Whether two slices have the same neighbors at the same distances, and so the same fits.
  bool alike(int k, int other) const noexcept {
    return kind_of_slice_[static_cast<std::size_t>(k)] == kind_of_slice_[static_cast<std::size_t>(other)];
  }

  /// Whether at() may be called: not if all slices are spaced differently.
  bool knows_edges() const noexcept { return !edges_.empty(); }
  /// The fit of a voxel's neighborhood that the volume's edge cuts off, for a neighborhood without padding.
  const PlaneFit& at(int i, int j, int k) const noexcept {
    const auto row = static_cast<std::size_t>(reduced(j, dimensions_.y, radius_.y, small_.y));
    const auto column = static_cast<std::size_t>(reduced(i, dimensions_.x, radius_.x, small_.x));
    const auto rows = static_cast<std::size_t>(small_.y);
    const auto columns = static_cast<std::size_t>(small_.x);
    return edges_[(kind_of_slice_[static_cast<std::size_t>(k)] * rows + row) * columns + column];
  }

 private:
  /// The voxel with the same cut-off neighborhood in a volume just large enough for one complete neighborhood.
  static int reduced(int i, int size, int radius, int small) noexcept {
    return i < radius ? i : i >= size - radius ? small - (size - i) : radius;
  }
  void add_edges(const SliceKernel& kernel);

  double scale_mm_ = 0;
  glm::dmat3 to_patient_{1};
  glm::ivec3 dimensions_{0};
  glm::ivec3 radius_{0};
  glm::ivec3 small_{0};
  std::vector<PlaneFit> whole_;
  std::vector<Sums> whole_sums_;
  std::vector<std::size_t> kind_of_slice_;  ///< slices of one kind have the same neighbors at the same distances
  std::vector<PlaneFit> edges_;             ///< by column, row, kind
};

}  // namespace palpate::io::internal
