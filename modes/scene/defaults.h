#pragma once

/// The defaults of a scene, with their units and reasons. Others are elsewhere: io::default_gradient_scale_mm()
/// (io/fields/gradient.h) finds the gradient's scale from a scan's voxels; the simulated device and hand have their own
/// (device/simulated/simulated_stylus.h, simulated_hand.h).

namespace palpate::modes::defaults {

/// k of the coupling, N/m: the safe value of Palmerius (2007), section 5; raised if the device allows.
inline constexpr double stiffness_n_per_m = 400.0;

// Strengths, N: strong enough to be felt, and below every device's continuous force.
inline constexpr double skin_strength_n = 1.0;
inline constexpr double bone_strength_n = 2.5;
inline constexpr double friction_strength_n = 0.1;

// Limits of the safety filter. The slew limit has to stay above k * speed limit, or contact becomes unstable.
inline constexpr double force_limit_n = 3.0;
inline constexpr double slew_limit_n_per_ms = 1.0;
inline constexpr double ramp_s = 0.5;
inline constexpr double speed_limit_m_per_s = 1.0;

/// Millimeters of patient for one millimeter of hand.
inline constexpr double workspace_scale = 1.0;

// The anchor that keeps a held proxy on its iso-surface (anchor.h), mm of patient.
/// Largest correction in a sub-step.
inline constexpr double anchor_step_mm = 0.1;
/// Travel over which a held level returns to the sampled value. Much longer than a voxel, so that the interpolation is
/// not felt.
inline constexpr double level_length_mm = 20.0;
/// The anchor is not drawn to an iso-surface that is farther away than this.
inline constexpr double level_reach_mm = 1.0;

// Subdivision of a tick (haptic_step.h): probe travel of one sub-step, mm of patient, and the most sub-steps of a
// tick.
inline constexpr double sub_step_mm = 0.1;
inline constexpr int most_sub_steps = 8;
/// The longest jump of the proxy between two samples when a surface yields, mm of patient: less than the thinnest
/// boundary that a CT can show.
inline constexpr double proxy_step_mm = 0.125;
/// The largest number of halts in a tick.
inline constexpr int most_halts = 32;

}  // namespace palpate::modes::defaults
