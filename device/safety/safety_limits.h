#pragma once

/// The limits of the safety filter with their defaults, in one place because they depend on each other.

namespace palpate::device {

struct SafetyLimits {
  double force = 3.0;               ///< N: the longest force vector asked of a device
  double device_force = 1e9;        ///< N: the device's own Specification::maximum_force
  double slew = 1000.0;             ///< N/s; below stiffness x speed (here 400 N/m x 1 m/s) contact turns unstable
  double slew_time = 0.002;         ///< s: a late tick counts as this long, so that the force makes no step
  double ramp_time = 0.5;           ///< s from armed to full force, and to zero when the controlling thread is silent
  double fall_time = 0.05;          ///< s from full force to zero after a fault or when disarmed
  double speed = 1.0;               ///< m/s: a faster hand is a fault
  double speed_filter_time = 2e-3;  ///< s: low pass on the speed, so that a position step does not count as speed
  double force_age = 0.010;         ///< s: an older force counts as zero
  double pose_age = 0.010;          ///< s without a new pose: the force counts as zero
  double stall_time = 0.100;        ///< s: a fault if a force or pose is older, or a tick later
  double heartbeat_time = 2.0;      ///< s without a sign of life of the controlling thread: a fault
};

}  // namespace palpate::device
