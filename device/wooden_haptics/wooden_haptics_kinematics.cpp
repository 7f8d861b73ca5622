#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/vectors.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {

namespace {

double direction(const WoodenHapticsSettings& s, std::size_t axis) {
  return s.motor_aligned[axis] ? -1 : 1;
}
double gearing(const WoodenHapticsSettings& s, std::size_t axis) {
  return s.capstan_diameter[axis] / s.body_diameter[axis];
}

/// From the arm's own frame (x towards the user, y right, z up), as its publication has it.
Vec3 to_device_frame(const Vec3& arm) {
  return {arm.y, arm.z, arm.x};
}
Vec3 to_arm_frame(const Vec3& device) {
  return {device.z, device.x, device.y};
}

}  // namespace

Vec3 wooden_haptics_angles(const WoodenHapticsSettings& settings, const std::array<int, 3>& counts) noexcept {
  Vec3 angles;
  for (std::size_t i = 0; i < 3; ++i) {
    const double turns = static_cast<double>(counts[i]) / settings.counts_per_turn[i];
    angles[static_cast<int>(i)] =
        settings.encoder_sign[i] * direction(settings, i) * 2 * std::numbers::pi * turns * gearing(settings, i);
  }
  return angles;
}

Vec3 wooden_haptics_position(const WoodenHapticsSettings& settings, const Vec3& angles) noexcept {
  const double reach = settings.lower_length * std::sin(angles.y) + settings.upper_length * std::sin(angles.z);
  const double height =
      settings.base_height + settings.lower_length * std::cos(angles.y) - settings.upper_length * std::cos(angles.z);
  return to_device_frame({std::cos(angles.x) * reach - settings.origin[0],
                          std::sin(angles.x) * reach - settings.origin[1], height - settings.origin[2]});
}

Vec3 wooden_haptics_torques(const WoodenHapticsSettings& settings, const Vec3& angles, const Vec3& force) noexcept {
  const Vec3 f = to_arm_frame(force);
  const double reach = settings.lower_length * std::sin(angles.y) + settings.upper_length * std::sin(angles.z);
  const double outward = std::cos(angles.x) * f.x + std::sin(angles.x) * f.y;
  const double sideways = -std::sin(angles.x) * f.x + std::cos(angles.x) * f.y;
  return {reach * sideways, settings.lower_length * (std::cos(angles.y) * outward - std::sin(angles.y) * f.z),
          settings.upper_length * (std::cos(angles.z) * outward + std::sin(angles.z) * f.z)};
}

std::array<int, 3> wooden_haptics_currents(const WoodenHapticsSettings& settings, const Vec3& torques) noexcept {
  if (!is_finite(torques)) return {};
  std::array<double, 3> amperes{};
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    amperes[i] =
        torques[static_cast<int>(i)] * direction(settings, i) * gearing(settings, i) / settings.torque_constant[i];
    largest = std::max(largest, std::abs(amperes[i]));
  }
  if (!std::isfinite(largest)) return {};
  const double factor = largest > settings.current_limit ? settings.current_limit / largest : 1;
  std::array<int, 3> milliamperes{};
  for (std::size_t i = 0; i < 3; ++i) {
    // Towards zero: rounding up would pass the limit by half a milliampere.
    milliamperes[i] = std::clamp(static_cast<int>(1000 * factor * amperes[i]), -32767, 32767);
  }
  return milliamperes;
}

}  // namespace palpate::device
