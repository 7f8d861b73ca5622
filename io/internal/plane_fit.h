#pragma once

/// The plane that fits a neighbourhood best: from weighted sums to a gradient.

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// Gradient in patient space = slope * (sums of value times offset along p, q, w) + constant * (sum of values).
struct PlaneFit {
  glm::mat3 slope{0};
  glm::vec3 constant{0};
};

/// From the sums of the weights themselves (1, p, q, w, pp, pq, qq, pw, qw, ww: `stride` floats apart). A direction
/// along which the neighbourhood has no extent worth a slope (a single slice, a lone voxel beside padding) gets slope
/// 0. to_patient: gradient along (p, q, w) -> patient space, rescale slope included.
PlaneFit fit_plane(const float* sums, std::size_t stride, double scale_mm, const glm::dmat3& to_patient) noexcept;

}  // namespace palpate::io::internal
