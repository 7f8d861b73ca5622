#include "testdata/shape.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

namespace palpate::testdata {
namespace {

Distance from_center(const Vec3& offset, double radius) noexcept {
  const double length = glm::length(offset);
  return {length - radius, length > 0 ? offset / length : Vec3(0)};
}

struct DistanceVisitor {
  Vec3 position;
  Distance operator()(const HalfSpace& s) const noexcept {
    return {glm::dot(s.outward, position) - s.offset, s.outward};
  }
  Distance operator()(const Ball& s) const noexcept { return from_center(position - s.center, s.radius); }
  Distance operator()(const Cylinder& s) const noexcept {
    const Vec3 offset = position - s.point;
    return from_center(offset - glm::dot(offset, s.axis) * s.axis, s.radius);
  }
};

struct CurvatureVisitor {
  double operator()(const HalfSpace&) const noexcept { return 0; }
  double operator()(const Ball& s) const noexcept { return 1 / s.radius; }
  double operator()(const Cylinder& s) const noexcept { return 1 / s.radius; }
};

/// Volume of the unit cube below the plane m . x = a, for 0 <= m1 <= m2 <= m3, m1 + m2 + m3 = 1 and a <= 1/2.
double lower_half(double m1, double m2, double m3, double a) noexcept {
  const double m12 = m1 + m2;
  if (a < m1) {
    return a * a * a / (6 * m1 * m2 * m3);
  }
  const double v1 = m1 > 0 ? m1 * m1 / (6 * m2 * m3) : 0;
  if (a < m2) {
    return a * (a - m1) / (2 * m2 * m3) + v1;
  }
  if (a >= m12 && m12 <= m3) {
    return (2 * a - m12) / (2 * m3);
  }
  double volume = m1 * m1 * (m1 - 3 * a) + m2 * m2 * (m2 - 3 * a);
  if (a < m3) {
    volume += a * a * (3 * m12 - a);
  } else {
    volume += a * a * (3 - 2 * a) + m3 * m3 * (m3 - 3 * a);
  }
  return volume / (6 * m1 * m2 * m3);
}

}  // namespace

Distance distance_to(const Shape& shape, const Vec3& position_mm) noexcept {
  return std::visit(DistanceVisitor{position_mm}, shape);
}

double curvature_of(const Shape& shape) noexcept {
  return std::visit(CurvatureVisitor{}, shape);
}

double fraction_behind_plane(const Vec3& normal, double offset, const Vec3 (&edges)[3]) noexcept {
  double m[3] = {std::abs(glm::dot(normal, edges[0])), std::abs(glm::dot(normal, edges[1])),
                 std::abs(glm::dot(normal, edges[2]))};
  std::sort(std::begin(m), std::end(m));
  const double sum = m[0] + m[1] + m[2];
  const double a = offset / sum + 0.5;
  if (!(a > 0)) {
    return 0;
  }
  if (a >= 1) {
    return 1;
  }
  // A side this thin changes the fraction by less than itself, but would cancel in the cubic's numerator.
  constexpr double thin = 1e-6;
  const double m1 = m[0] / sum < thin ? 0 : m[0] / sum;
  const double m2 = m[1] / sum < thin ? 0 : m[1] / sum;
  const double m3 = 1 - m1 - m2;
  const double half = lower_half(m1, m2, m3, std::min(a, 1 - a));
  return a <= 0.5 ? half : 1 - half;
}

}  // namespace palpate::testdata
