#pragma once

/// Symmetric positive definite 3 x 3 systems.

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace palpate::solver::internal {

using Vec3 = glm::dvec3;

struct Symmetric3 {
  double xx, yy, zz, xy, xz, yz;

  static Symmetric3 identity(double scale) { return {scale, scale, scale, 0, 0, 0}; }

  void add_identity(double scale) {
    xx += scale;
    yy += scale;
    zz += scale;
  }
  void add(const Symmetric3& other) {
    xx += other.xx;
    yy += other.yy;
    zz += other.zz;
    xy += other.xy;
    xz += other.xz;
    yz += other.yz;
  }
  void add_dyad(const Vec3& v, double scale) {
    const Vec3 w = v * scale;
    xx += w.x * v.x;
    yy += w.y * v.y;
    zz += w.z * v.z;
    xy += w.x * v.y;
    xz += w.x * v.z;
    yz += w.y * v.z;
  }
  Vec3 times(const Vec3& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }

  /// L D L^T without pivoting; a pivot that rounding has made smaller than `floor` becomes `floor`.
  Vec3 solve(const Vec3& b, double floor = 0) const {
    const double d1 = std::fmax(xx, floor);
    const double l21 = xy / d1;
    const double l31 = xz / d1;
    const double d2 = std::fmax(yy - l21 * xy, floor);
    const double c32 = yz - l31 * xy;
    const double l32 = c32 / d2;
    const double d3 = std::fmax(zz - l31 * xz - l32 * c32, floor);
    const double y2 = b.y - l21 * b.x;
    const double y3 = b.z - l31 * b.x - l32 * y2;
    const double x3 = y3 / d3;
    const double x2 = y2 / d2 - l32 * x3;
    return {b.x / d1 - l21 * x2 - l31 * x3, x2, x3};
  }
};

}  // namespace palpate::solver::internal
