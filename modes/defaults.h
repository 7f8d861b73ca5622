#pragma once

/// Every default that a hand may feel, in one place, with its unit and its reason. But for the gradient's scale, which
/// io::default_gradient_scale_mm() (io/gradient.h) finds from a scan's voxels.

namespace palpate::modes::defaults {

/// k of the coupling, N/m: the safe value of Palmerius (2007), section 5; raised where the device allows.
inline constexpr double stiffness_n_per_m = 400.0;

// Strengths, N: felt, and below every device's continuous force.
inline constexpr double skin_strength_n = 1.0;
inline constexpr double bone_strength_n = 2.5;
inline constexpr double friction_strength_n = 0.1;

// Limits of the safety filter. The slew limit has to stay above k * speed limit, or contact becomes unstable.
inline constexpr double force_limit_n = 3.0;
inline constexpr double slew_limit_n_per_ms = 1.0;
inline constexpr double ramp_s = 0.5;
inline constexpr double speed_limit_m_per_s = 1.0;

/// Millimetres of patient for one millimetre of hand.
inline constexpr double workspace_scale = 1.0;

// The anchor that keeps a held proxy on its iso-surface (anchor.h), mm of patient.
/// Largest correction in a sub-step.
inline constexpr double anchor_step_mm = 0.1;
/// Travel over which a held level returns to the sampled value: long beside a voxel, whose interpolation shall not be
/// felt.
inline constexpr double level_length_mm = 20.0;
/// Farthest iso-surface that it is drawn to.
inline constexpr double level_reach_mm = 1.0;

// Subdivision of a frame (haptic_step.h): probe travel of one sub-step, mm of patient, and the most sub-steps of a
// frame.
inline constexpr double sub_step_mm = 0.1;
inline constexpr int most_sub_steps = 8;
/// Farthest that the proxy jumps unsampled when a surface gives way, mm of patient: thin beside a boundary that a CT
/// can show. And the most halts of a frame.
inline constexpr double proxy_step_mm = 0.25;
inline constexpr int most_halts = 16;

/// The simulated device: like a Desktop PHANTOM. One definition that every study shares.
struct SimulatedDevice {
  double mass_kg = 0.045;
  double coulomb_friction_n = 0.06;
  double viscous_friction_n_s_per_m = 0.3;
  double position_step_m = 0.02e-3;
  double rate_hz = 1000.0;  ///< with a zero-order hold
  double delay_s = 0.5e-3;
};

/// The simulated hand that holds it.
struct SimulatedHand {
  double mass_kg = 0.050;
  double stiffness_n_per_m = 500.0;
  double damping_n_s_per_m = 4.0;
  double tremor_low_hz = 8.0;
  double tremor_high_hz = 12.0;
  double tremor_rms_m = 0.05e-3;
};

}  // namespace palpate::modes::defaults
