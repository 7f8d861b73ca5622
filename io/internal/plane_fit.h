#pragma once

/// The plane that fits a neighbourhood best: from weighted sums to a gradient.

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palpate::io::internal {

/// Gradient in patient space = slope . (sums of value times offset) + constant * (sum of values).
struct PlaneFit {
  glm::dmat3 slope{0};
  glm::dvec3 constant{0};

  glm::vec3 gradient(float sum, float along_p, float along_q, float along_w) const noexcept {
    const glm::dvec3 g = slope * glm::dvec3(along_p, along_q, along_w) + static_cast<double>(sum) * constant;
    return {static_cast<float>(g.x), static_cast<float>(g.y), static_cast<float>(g.z)};
  }
};

/// From the sums of the weights themselves (1, p, q, w, pp, pq, qq, pw, qw, ww: `stride` floats apart). A direction
/// along which the neighbourhood has no extent worth a slope (a single slice, a lone voxel beside padding) gets slope
/// 0. to_patient: gradient along (p, q, w) -> patient space, rescale slope included.
PlaneFit fit_plane(const float* sums, std::size_t stride, double scale_mm, const glm::dmat3& to_patient) noexcept;

}  // namespace palpate::io::internal
