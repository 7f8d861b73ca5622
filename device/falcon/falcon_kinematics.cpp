#include "device/falcon/falcon_kinematics.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "device/vectors.h"

namespace palpate::device {

namespace {

/// One leg: first joint, second link and the parallelogram's tilt, radians.
struct Leg {
  double first;
  double second;
  double tilt;
};

std::optional<Leg> solve_leg(const FalconGeometry& g, int index, const Vec3& position) noexcept {
  const double azimuth = g.azimuth[static_cast<std::size_t>(index)];
  const double c = std::cos(azimuth);
  const double s = std::sin(azimuth);
  const double along = position.x * c + position.y * s - g.base_radius + g.end_offset_along;
  const double across = -position.x * s + position.y * c - g.base_offset;
  const double out = position.z;

  const double cosine = (across + g.end_offset_across) / g.shin;
  if (!(std::abs(cosine) < 1) || !(out > 0)) return std::nullopt;
  const double tilt = std::acos(cosine);
  const double reach = g.shin_start + g.shin_end + g.shin * std::sin(tilt);
  // A two-link arm in its plane, along = thigh cos(first) + reach cos(second), in the half-angle tangent of `first`.
  const double common = out * out + along * along + g.thigh * g.thigh - reach * reach;
  const double l0 = common - 2 * along * g.thigh;
  const double l1 = -4 * g.thigh * out;
  const double l2 = common + 2 * along * g.thigh;
  const double discriminant = l1 * l1 - 4 * l0 * l2;
  if (!(discriminant > 0)) return std::nullopt;
  // The root (-l1 - sqrt) / (2 l2), turned round so that nothing cancels: l1 < 0 in front of the body.
  const double first = 2 * std::atan(2 * l0 / (std::sqrt(discriminant) - l1));
  const double second = std::atan2(out - g.thigh * std::sin(first), along - g.thigh * std::cos(first));
  return Leg{first, second, tilt};
}

}  // namespace

std::optional<Vec3> falcon_angles(const FalconGeometry& geometry, const Vec3& position) noexcept {
  Vec3 angles;
  for (int i = 0; i < 3; ++i) {
    const std::optional<Leg> leg = solve_leg(geometry, i, position);
    if (!leg) return std::nullopt;
    angles[i] = leg->first;
  }
  return angles;
}

std::optional<glm::dmat3> falcon_jacobian(const FalconGeometry& geometry, const Vec3& position) noexcept {
  glm::dmat3 jacobian;
  for (int i = 0; i < 3; ++i) {
    const std::optional<Leg> leg = solve_leg(geometry, i, position);
    if (!leg) return std::nullopt;
    const double lever = geometry.thigh * std::sin(leg->second - leg->first);
    const double cotangent = std::cos(leg->tilt) / std::sin(leg->tilt);
    const double c = std::cos(geometry.azimuth[static_cast<std::size_t>(i)]);
    const double s = std::sin(geometry.azimuth[static_cast<std::size_t>(i)]);
    // The last entry is where libnifalcon has sin^2(second): a quarter of the largest entry wrong.
    const Vec3 row = Vec3(c * std::cos(leg->second) - s * cotangent, s * std::cos(leg->second) + c * cotangent,
                          std::sin(leg->second)) /
                     lever;
    if (!is_finite(row)) return std::nullopt;
    for (int column = 0; column < 3; ++column) jacobian[column][i] = row[column];
  }
  return jacobian;
}

namespace {

/// The position of these angles by Newton's method from `start`, on any branch and at any distance.
std::optional<Vec3> newton(const FalconGeometry& geometry, const Vec3& angles, const Vec3& start) noexcept {
  constexpr double close_enough = 1e-11;  // rad: 1e-12 m
  Vec3 position = start;
  std::optional<Vec3> reached = falcon_angles(geometry, position);
  if (!reached || !is_finite(angles)) return std::nullopt;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Vec3 error = angles - *reached;
    if (glm::dot(error, error) < close_enough * close_enough) return position;
    const std::optional<glm::dmat3> jacobian = falcon_jacobian(geometry, position);
    if (!jacobian || !(std::abs(glm::determinant(*jacobian)) > 1e-9)) return std::nullopt;
    Vec3 step = glm::inverse(*jacobian) * error;
    // Steps that leave the workspace or make matters worse are halved.
    bool moved = false;
    for (int halving = 0; halving < 12 && !moved; ++halving, step *= 0.5) {
      const std::optional<Vec3> tried = falcon_angles(geometry, position + step);
      if (!tried || glm::length(angles - *tried) > glm::length(error)) continue;
      position += step;
      reached = tried;
      moved = true;
    }
    if (!moved) return std::nullopt;
  }
  return std::nullopt;
}

/// Angles mean two positions that a singularity separates, and the arms cannot pass it. Within the vendor's cube the
/// determinant is negative everywhere.
bool is_on_its_branch(const FalconGeometry& geometry, const Vec3& position) noexcept {
  const std::optional<glm::dmat3> jacobian = falcon_jacobian(geometry, position);
  return jacobian && glm::determinant(*jacobian) < 0;
}

}  // namespace

std::optional<Vec3> falcon_position(const FalconGeometry& geometry, const Vec3& angles, const Vec3& start) noexcept {
  const Vec3 middle(0, 0, geometry.center);
  for (const Vec3& from : {start, middle}) {
    const std::optional<Vec3> found = newton(geometry, angles, from);
    if (found && is_on_its_branch(geometry, *found)) {
      return glm::length(*found - middle) <= geometry.reach ? found : std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<Vec3> falcon_torques(const FalconGeometry& geometry, const Vec3& position, const Vec3& force) noexcept {
  const std::optional<glm::dmat3> jacobian = falcon_jacobian(geometry, position);
  if (!jacobian || !(std::abs(glm::determinant(*jacobian)) > 1e-9)) return std::nullopt;
  const Vec3 torques = glm::inverse(glm::transpose(*jacobian)) * force;
  if (!is_finite(torques)) return std::nullopt;
  return torques;
}

}  // namespace palpate::device
