#pragma once

/// The best-fitting plane of a neighborhood: from weighted sums to a gradient.

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// Gradient in patient space = slope * (sums of value times offset along p, q, w) + constant * (sum of values).
struct PlaneFit {
  glm::mat3 slope{0};
  glm::vec3 constant{0};
};

/// The gradient of a voxel whose sums (1, p, q, w) are `stride` floats apart. Never a negative zero, so leaving out a
/// sum that would be multiplied by zero changes no bit.
inline glm::vec3 gradient_of(const PlaneFit& fit, const float* s, std::size_t stride) noexcept {
  glm::vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    gradient[axis] = ((fit.slope[0][axis] * s[stride] + fit.slope[1][axis] * s[2 * stride]) +
                      (fit.slope[2][axis] * s[3 * stride] + fit.constant[axis] * s[0])) +
                     0.0F;
  }
  return gradient;
}

/// The fit from the sums of the weights themselves (1, p, q, w, pp, pq, qq, pw, qw, ww: `stride` floats apart). The
/// slope is 0 along a direction in which the neighborhood has too little extent (a single slice, a lone voxel beside
/// padding). to_patient: gradient along (p, q, w) -> patient space, rescale slope included.
PlaneFit fit_plane(const float* sums, std::size_t stride, double scale_mm, const glm::dmat3& to_patient) noexcept;

/// The same, with the same bits, for the voxels of a row from `begin` to `end`, a multiple of four. Sums and fits are
/// tile_width floats apart, the fits in rows as in straight_sums.h.
void fit_planes(const float* sums, int begin, int end, double scale_mm, const glm::dmat3& to_patient,
                float* fits) noexcept;

}  // namespace palpate::io::internal
