#pragma once

/// The ceilings of the whole chain, and the limits of the safety filter with their defaults. They are in one file
/// because they depend on each other. plugin/docs/safety.md has them as a table.

namespace palpate::device {

/// No scene, state, setting or option can pass these. If a scene or state asks for more, the ceiling is used instead
/// and a message says so (plugin/session/felt_limits.h). A setting or option that asks for more is refused by name. If
/// a device can do less, its own limit holds (Specification).
namespace ceiling {

/// N: the force of an omega (Force Dimension, 12 N). It is the strongest stylus whose force we know from its maker. A
/// person controls 2 to 6 N with one finger for minutes (Jones, "Perception and control of finger forces", 1998).
inline constexpr double force_n = 12;
/// N/s: at `speed_m_per_s` the force of a wall of 1000 N/m still follows without delay. Only Force Dimension's
/// devices have a stiffer default. OpenHaptics calls a faster change a force impulse and refuses it
/// (HD_FORCE_IMPULSE).
inline constexpr double slew_n_per_s = 1000;
/// s, a tick or exchange that takes longer counts as this long, so a late one makes no step in the force.
inline constexpr double slew_time_s = 0.002;
/// s, the shortest ramp. A person can let go in less time: a simple reaction to touch takes about 0.16 s.
inline constexpr double ramp_s = 0.25;
inline constexpr double resume_ramp_s = ramp_s;  ///< s: after a zero that the link puts in
inline constexpr double fall_s = 0.05;           ///< s: from full force to zero after a fault or when disarmed
/// m/s: see `slew_n_per_s`. Hands that explore a surface stay far below.
inline constexpr double speed_m_per_s = 1;
/// N/m: above it the simulated device rings on oblique walls (`palpate-bench stability`).
inline constexpr double stiffness_n_per_m = 3000;
inline constexpr double force_age_s = 0.010;       ///< a computed force that is older counts as zero
inline constexpr double pose_age_s = 0.010;        ///< without a new pose for this time the force counts as zero
inline constexpr double link_force_age_s = 0.020;  ///< a written force that is not renewed counts as zero in the link
inline constexpr double stall_s = 0.100;           ///< a fault if a force, pose or tick is later
inline constexpr double refusal_s = 0.050;         ///< a fault if a device refuses every force for this time
inline constexpr double guardian_s = 0.5;          ///< a fault if the guardian shows no sign of life for this time
inline constexpr double heartbeat_s = 2.0;         ///< a fault if the controlling thread is silent for this time

}  // namespace ceiling

struct SafetyLimits {
  double force = 3.0;                            ///< N: the longest force vector asked of a device
  double device_force = ceiling::force_n;        ///< N: the device's own Specification::maximum_force
  double slew = ceiling::slew_n_per_s;           ///< N/s; below stiffness x speed contact turns unstable
  double slew_time = ceiling::slew_time_s;       ///< s: a late tick counts as this long
  double ramp_time = 0.5;                        ///< s from armed to full force
  double fall_time = ceiling::fall_s;            ///< s from full force to zero after a fault or when disarmed
  double speed = ceiling::speed_m_per_s;         ///< m/s: a faster hand is a fault
  double speed_smoothing_time = 2e-3;            ///< s: low pass, so that a position step does not count as speed
  double force_age = ceiling::force_age_s;       ///< s: an older force counts as zero
  double pose_age = ceiling::pose_age_s;         ///< s without a new pose: the force counts as zero
  double stall_time = ceiling::stall_s;          ///< s: a fault if a force or pose is older, or a tick later
  double heartbeat_time = ceiling::heartbeat_s;  ///< s without a sign of life of the controlling thread: a fault
};

}  // namespace palpate::device
