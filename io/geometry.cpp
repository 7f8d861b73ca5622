#include "io/geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace palpate::io {
namespace {

// Far below the resolution of a position in mm, far above the rounding of the transform: a voxel's center becomes an
// integer index, so that its value is not blended with its neighbors'.
constexpr double snap = 1e-9;

double snapped(double index) noexcept {
  const double nearest = std::round(index);
  return std::abs(index - nearest) < snap ? nearest : index;
}

int interval_at(const Geometry& geometry, double k) noexcept {
  const int last = static_cast<int>(geometry.slice_positions.size()) - 2;
  if (!(k > 0)) return 0;
  return k < last ? static_cast<int>(k) : std::max(last, 0);
}

Vec3 step_of_interval(const Geometry& geometry, int interval) noexcept {
  if (geometry.slice_positions.size() < 2) return geometry.step;
  const auto k = static_cast<std::size_t>(interval);
  return geometry.slice_positions[k + 1] - geometry.slice_positions[k];
}

}  // namespace

Vec3 Geometry::to_patient(const Vec3& index) const noexcept {
  if (slice_positions.empty()) return Vec3(0);
  const int interval = interval_at(*this, index.z);
  return slice_positions[static_cast<std::size_t>(interval)] +
         (index.z - interval) * step_of_interval(*this, interval) + index.x * spacing_i * direction_i +
         index.y * spacing_j * direction_j;
}

Vec3 Geometry::to_index(const Vec3& position_mm) const noexcept {
  if (slice_positions.empty()) return Vec3(0);
  const Vec3 normal = glm::cross(direction_i, direction_j);
  const double height = glm::dot(position_mm, normal);
  const auto above = std::upper_bound(slice_positions.begin(), slice_positions.end(), height,
                                      [&](double h, const Vec3& slice) { return h < glm::dot(slice, normal); });
  const int interval = interval_at(*this, static_cast<double>(above - slice_positions.begin()) - 1);
  const Vec3 step_here = step_of_interval(*this, interval);
  const Vec3 from_slice = position_mm - slice_positions[static_cast<std::size_t>(interval)];
  const double t = glm::dot(from_slice, normal) / glm::dot(step_here, normal);

  // Direction cosines are rounded to a few digits in some files and then are not quite perpendicular.
  const Vec3 in_plane = from_slice - t * step_here;
  const double skew = glm::dot(direction_i, direction_j);
  const double ii = glm::dot(direction_i, direction_i);
  const double jj = glm::dot(direction_j, direction_j);
  const double a = glm::dot(in_plane, direction_i);
  const double b = glm::dot(in_plane, direction_j);
  const double determinant = ii * jj - skew * skew;
  return {snapped((a * jj - b * skew) / determinant / spacing_i),
          snapped((b * ii - a * skew) / determinant / spacing_j), snapped(interval + t)};
}

bool Geometry::contains(const Vec3& index) const noexcept {
  return index.x >= 0 && index.x <= dimensions.x - 1 && index.y >= 0 && index.y <= dimensions.y - 1 && index.z >= 0 &&
         index.z <= dimensions.z - 1;
}

double Geometry::slice_spacing() const noexcept {
  return glm::dot(step, glm::normalize(glm::cross(direction_i, direction_j)));
}

glm::dmat3 Geometry::index_gradient_to_patient(double k) const noexcept {
  const glm::dmat3 jacobian(spacing_i * direction_i, spacing_j * direction_j,
                            step_of_interval(*this, interval_at(*this, k)));
  return glm::transpose(glm::inverse(jacobian));
}

}  // namespace palpate::io
