#pragma once

/// The Novint Falcon's arms: a delta with three legs (R. E. Stamper, "A Three Degree of Freedom Parallel Manipulator
/// with Only Translational Degrees of Freedom", 1997), with the dimensions that libnifalcon measured.
///
/// The robot's frame: z along the pull-out axis towards the user, x to the right, y up, the origin in the body. Angles
/// are radians, of the legs' first joints, from the frame's plane.

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "device/stylus.h"

namespace palpate::device {

/// Meters and radians.
struct FalconGeometry {
  double thigh = 0.060;               ///< a: from the first to the second joint
  double shin = 0.1025;               ///< b: the parallelogram's long side
  double shin_start = 0.01125;        ///< d
  double shin_end = 0.01125;          ///< e
  double end_offset_along = 0.01443;  ///< c
  double end_offset_across = -0.025;  ///< f
  double base_radius = 0.0400;        ///< r
  double base_offset = -0.02309;      ///< s
  std::array<double, 3> azimuth{1.8325957145940461, -0.2617993877991494, -2.3561944901923448};  ///< 105, -15, -135 deg
  double angle_at_zero = 0.6108652381980153;  ///< 35 deg: a leg's angle at encoder count 0
  /// 360 deg in 320 slots x 4 edges of the motor's wheel, geared by a 14.25 mm shaft on a 110 mm drum.
  double angle_per_count = 2 * 3.141592653589793 / 1280 * 14.25 / 110;
  double center = 0.120;  ///< m along z: the middle of the grip's reach, origin of the device's frame
  double reach = 0.090;   ///< m from the center to the corner of the vendor's 10 cm cube, at the stops
};

/// The joint angles of a position (m, robot's frame); nothing if it is out of reach.
std::optional<Vec3> falcon_angles(const FalconGeometry& geometry, const Vec3& position) noexcept;

/// d angle_leg / d position, row by row: m[column][row] as everywhere in GLM. Nothing if the position is out of reach,
/// or if the arms are stretched out and the Jacobian is singular.
std::optional<glm::dmat3> falcon_jacobian(const FalconGeometry& geometry, const Vec3& position) noexcept;

/// The position of joint angles by Newton's method from a nearby position, and if that fails from the middle, to 1e-11
/// rad. Nothing if there is none within the reach, or none on this side of the singularity at its edge.
std::optional<Vec3> falcon_position(const FalconGeometry& geometry, const Vec3& angles, const Vec3& start) noexcept;

/// N m on the three arms for a force (N) on the grip at a position: J^-T F.
std::optional<Vec3> falcon_torques(const FalconGeometry& geometry, const Vec3& position, const Vec3& force) noexcept;

}  // namespace palpate::device
