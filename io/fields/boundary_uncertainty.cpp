#include "io/fields/boundary_uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "io/quantile.h"

namespace palpate::io {
namespace {

constexpr std::size_t directions = 8;                         // of pairs, over half a turn
constexpr std::array<double, 4> reaches{2.5, 4.0, 5.5, 7.0};  // voxels: farther apart than one interpolation reaches
constexpr double slope_step = 0.25;                           // voxels, to both sides
constexpr double outlier = 3.0;                               // standard deviations: another structure
// Of the boundary's place by its phase between the voxels, rms, in voxels along an axis: as measured on tilted planes
// without noise. The cubic value is sharper along coarse axes (cubic_spline.h), and its phase shows more there.
constexpr double cubic_phase = 0.02, cubic_coarse_phase = 0.05, trilinear_phase = 0.04;
constexpr double coarse = 1.5;  // times the finest spacing
// Variance of the blur, in voxels squared: of the voxel's box and of the interpolation.
constexpr double cubic_blur = 1.0 / 12 + 0.58 * 0.58, trilinear_blur = 1.0 / 12 + 1.0 / 6;

/// Two unit vectors perpendicular to a unit vector and to each other.
std::array<Vec3, 2> tangents_of(const Vec3& normal) {
  const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 first = glm::normalize(glm::cross(normal, other));
  return {first, glm::cross(normal, first)};
}

/// Extent of a voxel along a unit direction, mm: how far one goes to the next voxel.
double voxel_along(const Geometry& g, const Vec3& direction) {
  const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
  return glm::length(Vec3(glm::dot(g.direction_i, direction) * g.spacing_i,
                          glm::dot(g.direction_j, direction) * g.spacing_j,
                          glm::dot(normal, direction) * g.slice_spacing()));
}

/// rms of the boundary's place along a unit normal by its phase between the voxels, mm.
double phase_mm(const Geometry& g, ValueMethod value, const Vec3& normal) {
  const std::array axes{g.direction_i, g.direction_j, glm::cross(g.direction_i, g.direction_j)};
  const std::array spacings{g.spacing_i, g.spacing_j, g.slice_spacing()};
  const double finest = *std::min_element(spacings.begin(), spacings.end());
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double phase = value == ValueMethod::trilinear    ? trilinear_phase
                         : spacings[axis] > coarse * finest ? cubic_coarse_phase
                                                            : cubic_phase;
    const double along = phase * spacings[axis] * glm::dot(axes[axis], normal);
    sum += along * along;
  }
  return std::sqrt(sum);
}

struct Pair {
  double angle = 0;       // of the pair's direction in the tangent plane
  double apart_mm = 0;    // between its points
  double difference = 0;  // of their values
};

/// Standard deviation of the value: of the pairs' differences less a tilt of the plane, without outliers.
double noise_of(const std::vector<Pair>& pairs) {
  // Least squares of difference = apart (a cos + b sin).
  double cc = 0, cs = 0, ss = 0, cd = 0, sd = 0;
  for (const Pair& p : pairs) {
    const double c = p.apart_mm * std::cos(p.angle), s = p.apart_mm * std::sin(p.angle);
    cc += c * c;
    cs += c * s;
    ss += s * s;
    cd += c * p.difference;
    sd += s * p.difference;
  }
  const double determinant = cc * ss - cs * cs;
  const double a = (ss * cd - cs * sd) / determinant, b = (cc * sd - cs * cd) / determinant;
  std::vector<double> residuals;
  residuals.reserve(pairs.size());
  for (const Pair& p : pairs) {
    residuals.push_back(std::abs(p.difference - p.apart_mm * (a * std::cos(p.angle) + b * std::sin(p.angle))));
  }
  const double robust = quantile(residuals, 0.5) / 0.6745;
  double sum = 0, count = 0;
  for (const double residual : residuals) {
    if (residual > outlier * robust) continue;
    sum += residual * residual;
    count += 1;
  }
  return count > 2 ? std::sqrt(sum / (count - 2) / 2) : 0;
}

}  // namespace

BoundaryUncertainty uncertainty_at(const FieldSource& source, const Geometry& geometry, ValueMethod value,
                                   const Vec3& place_mm, const Filter& filter) {
  BoundaryUncertainty result;
  result.two_sigma_mm = std::numeric_limits<double>::infinity();
  const Sample here = source.sample(place_mm, FieldSet::value | FieldSet::gradient);
  if (!here.inside || !(glm::length(here.gradient) > 0)) return result;
  const Vec3 normal = glm::normalize(here.gradient);
  const double voxel = voxel_along(geometry, normal);
  const auto tangents = tangents_of(normal);

  double slopes = 0, slope_count = 0;
  const auto add_slope = [&](const Vec3& place) {
    const Sample behind = source.sample(place - slope_step * voxel * normal, FieldSet::value);
    const Sample before = source.sample(place + slope_step * voxel * normal, FieldSet::value);
    if (!behind.inside || !before.inside) return;
    slopes += (before.value - behind.value) / (2 * slope_step * voxel);
    slope_count += 1;
  };
  add_slope(place_mm);
  std::vector<Pair> pairs;
  double bent = 0, bent_count = 0;  // sum of blur variance (mm^2) times the value's second difference (unit per mm^2)
  const double blur = value == ValueMethod::cubic ? cubic_blur : trilinear_blur;
  for (std::size_t n = 0; n < directions; ++n) {
    const double angle = std::numbers::pi * static_cast<double>(n) / directions;
    const Vec3 along = std::cos(angle) * tangents[0] + std::sin(angle) * tangents[1];
    const double step = voxel_along(geometry, along);
    for (const double reach : reaches) {
      const Vec3 away = reach * step * along;
      const Sample one = source.sample(place_mm + away, FieldSet::value);
      const Sample other = source.sample(place_mm - away, FieldSet::value);
      if (!one.inside || !other.inside) continue;
      pairs.push_back({.angle = angle, .apart_mm = 2 * reach * step, .difference = one.value - other.value});
      if (reach > reaches.front()) continue;
      const double width = reach * step;
      const bool is_blurred = filter.type != nullptr && filter.type->blur != nullptr;
      const double of_filter = is_blurred ? filter.type->blur(geometry, filter, along) : 0;
      const double variance = blur * step * step + of_filter;
      bent += variance * (one.value + other.value - 2 * here.value) / (width * width);
      bent_count += 1;
    }
    // The slope of neighbors on the tangent plane, half a voxel aside: more of them, less noise.
    add_slope(place_mm + 0.5 * step * along);
    add_slope(place_mm - 0.5 * step * along);
  }
  if (slope_count == 0 || pairs.size() < 2 * directions) return result;
  result.slope = slopes / slope_count;
  result.noise = noise_of(pairs);
  if (!(result.slope > 0)) return result;
  result.noise_mm = result.noise / result.slope;
  result.sampling_mm = phase_mm(geometry, value, normal);
  result.curvature_mm = bent_count > 0 ? -bent / bent_count / result.slope : 0;
  // The measured noise has the phase's part in it, unless the boundary runs along the voxels.
  result.two_sigma_mm = 2 * std::max(result.noise_mm, result.sampling_mm) + std::abs(result.curvature_mm);
  return result;
}

}  // namespace palpate::io
