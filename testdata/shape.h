#pragma once

/// The solids that phantoms are painted with: exact signed distances in patient space (LPS, mm).

#include <glm/vec3.hpp>
#include <variant>

namespace palpate::testdata {

using Vec3 = glm::dvec3;

/// Points with outward . p <= offset.
struct HalfSpace {
  Vec3 outward{0, 0, 1};  ///< unit
  double offset = 0;      ///< mm
};

struct Ball {
  Vec3 center{0};     ///< mm
  double radius = 1;  ///< mm
};

/// An endless straight cylinder.
struct Cylinder {
  Vec3 point{0};       ///< mm: any point of the axis
  Vec3 axis{0, 0, 1};  ///< unit
  double radius = 1;   ///< mm
};

using Shape = std::variant<HalfSpace, Ball, Cylinder>;

struct Distance {
  double signed_mm = 0;  ///< negative inside the shape
  Vec3 normal{0};  ///< gradient of the signed distance: unit, outward; zero at a ball's center or on a cylinder's axis
};

Distance distance_to(const Shape& shape, const Vec3& position_mm) noexcept;

/// Largest curvature of the surface, 1/mm: 0 for a half-space.
double curvature_of(const Shape& shape) noexcept;

/// The fraction of a box that lies behind a plane: the part of the parallelepiped {sum u_i edge_i, |u_i| <= 1/2} with
/// normal . x <= offset. Exact: Scardovelli and Zaleski, "Analytical relations connecting linear interfaces and volume
/// fractions in rectangular grids", J. Comput. Phys. 164 (2000), equations of section 2.2.
double fraction_behind_plane(const Vec3& normal, double offset, const Vec3 (&edges)[3]) noexcept;

}  // namespace palpate::testdata
