#pragma once

/// A hand that holds a stylus in a rigid grip: one mass, of hand and device together. A spring and a damper pull it to
/// the hand's target; the device's friction holds it back; the device's force pushes it.
///
/// (m_d + m_h) a = F - b v - c v/|v| + k_h (target - x) + b_h (target' - v)

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "device/stylus.h"

namespace palpate::device {

/// The simulated hand of every study.
struct HandModel {
  double mass = 0.050;          ///< kg
  double stiffness = 500;       ///< N/m
  double damping = 4;           ///< N s/m
  double tremor_rms = 0.05e-3;  ///< m, of each axis
  double tremor_lowest = 8;     ///< Hz
  double tremor_highest = 12;   ///< Hz
  std::uint64_t tremor_seed = 1;
};

/// The arm that the hand moves: like a Desktop PHANTOM's.
struct ArmModel {
  double mass = 0.045;                 ///< kg, felt at the tip
  double coulomb_friction = 0.06;      ///< N
  double viscous_friction = 0.3;       ///< N s/m
  Vec3 half_extent{0.08, 0.06, 0.06};  ///< m: mechanical stops, without rebound
};

struct BodyState {
  Vec3 position{0};  ///< m
  Vec3 velocity{0};  ///< m/s
};

/// Tremor: for each axis five sines with frequencies drawn evenly from the band, random phases and equal amplitudes.
class Tremor {
 public:
  explicit Tremor(const HandModel& hand);
  /// m, at a time in s.
  Vec3 operator()(double time) const noexcept;

 private:
  static constexpr int sines = 5;
  struct Sine {
    double frequency = 0;  // rad/s
    double phase = 0;
  };
  double amplitude_;  // m
  std::array<std::array<Sine, sines>, 3> axes_{};
};

/// One step of `duration` (s; 50 us or less) under a constant device force (N), towards a target that has a velocity.
/// Backward Euler with friction as an impulse: sticks exactly, never creates energy by itself.
void step_body(const ArmModel& arm, const HandModel& hand, const Vec3& force, const Vec3& target,
               const Vec3& target_velocity, double duration, BodyState& state) noexcept;

}  // namespace palpate::device
