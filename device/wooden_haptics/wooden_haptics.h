#pragma once

/// WoodenHaptics, the open-hardware arm (J. Forsslund, "WoodenHaptics: the open-source haptic device"): three actuated
/// axes over HID. Written from its public firmware and host sources and tested against a fake: never run on hardware.

#include <array>
#include <memory>
#include <string>

#include "device/axis_signs.h"
#include "device/stylus.h"

namespace palpate::device {

/// Meters, newton meters per ampere, amperes; per axis in the order a (base), b (lower body), c (upper body). Boards
/// and arms differ: keep yours in a JSON file whose keys are these names (read_wooden_haptics).
struct WoodenHapticsSettings {
  std::string preset;          ///< the arm; required, because the settings of another arm give far too large forces
  std::string address;         ///< the hidraw path; required, because other devices share its USB ids
  bool short_reports = false;  ///< firmware of 2016: reports of 8 bytes, no calibration button
  bool stylus_button = false;  ///< the stylus has a button, which adds 10000 to the fourth encoder
  std::array<double, 3> capstan_diameter{0.010, 0.010, 0.010};
  std::array<double, 3> body_diameter{0.160, 0.120, 0.120};
  double base_height = 0.080;                     ///< Ln
  double lower_length = 0.205;                    ///< Lb
  double upper_length = 0.245;                    ///< Lc
  std::array<double, 3> origin{0.220, 0, 0.080};  ///< of the workspace, in the arm's own frame
  double workspace_radius = 0.100;
  std::array<double, 3> torque_constant{0.0259, 0.0259, 0.0259};
  std::array<int, 3> counts_per_turn{2000, 2000, 2000};
  std::array<int, 3> encoder_sign{1, 1, 1};
  std::array<bool, 3> motor_aligned{false, true, false};  ///< motor and body turn the same way
  std::array<int, 3> home_counts{0, 0, 0};                ///< encoders in the home pose; for the 2019 arm {0, 0, 6000}
  double current_limit = 2.0;       ///< A: all three are scaled down together; the amplifiers bear it for 4 s
  double continuous_current = 1.0;  ///< A that each motor can bear permanently
  double maximum_force = 5.0;       ///< N
  double stiffness_limit = 1000;    ///< N/m
  bool guarded = true;              ///< start a guardian process if palpate-guardian is found
  AxisSigns signs;                  ///< of the device frame, beside those of the motors
};

/// "2015" and "2019" are the arms of haptikfabrikenapi (reports of 14 bytes), and "woody" is its default. "2016" is the
/// arm of woody-experimental (8 bytes); its encoder counts and its motors' directions have other signs. Throws
/// std::runtime_error with the list of names for any other.
WoodenHapticsSettings wooden_haptics_preset(const std::string& name);
/// Throws std::runtime_error naming the file, the key and what is wrong with it. The key "preset" is needed; keys that
/// are absent have the preset's values.
WoodenHapticsSettings read_wooden_haptics(const std::string& json_file);
/// Throws std::runtime_error naming a value that no arm can have. A torque constant and the counts per turn differ from
/// the preset's by a factor of 2.5 at most, a diameter and a length by 1.6. Together they change the current for a
/// force by a factor of 2.5 at most, on each axis.
void check(const WoodenHapticsSettings& settings);

/// Radians of the three bodies for encoder counts: dir 2 pi count / counts_per_turn x capstan / body.
Vec3 wooden_haptics_angles(const WoodenHapticsSettings& settings, const std::array<int, 3>& counts) noexcept;
/// m in the device's frame (x right, y up, z towards the user; the arm's own y, z, x).
Vec3 wooden_haptics_position(const WoodenHapticsSettings& settings, const Vec3& angles) noexcept;
/// N m on the three bodies for a force (N, device's frame): J^T F.
Vec3 wooden_haptics_torques(const WoodenHapticsSettings& settings, const Vec3& angles, const Vec3& force) noexcept;
/// Motor currents, mA, within the current limit by one common factor; zeros if a torque is not finite.
std::array<int, 3> wooden_haptics_currents(const WoodenHapticsSettings& settings, const Vec3& torques) noexcept;

/// The stylus is not open yet. open() throws std::runtime_error naming the device and what to do. The state is
/// State::homing, without force, until the user has put the arm into its home pose and pressed its calibration button.
/// If the button is pressed later, that is the fault LinkFault::unhomed. Firmware of 2016 reports no button: the pose
/// in which the arm is opened counts as the home pose.
std::unique_ptr<Stylus> make_wooden_haptics(const WoodenHapticsSettings& settings);

}  // namespace palpate::device
