#pragma once

/// Damps ringing as soon as it begins. A passive wall returns at most the energy that the hand put in. A wall that is
/// too stiff for its delay returns more, at the frequencies at which it rings. This energy is measured, and damping is
/// added while it is above zero: B. Hannaford and J.-H. Ryu, "Time-domain passivity control of haptic interfaces",
/// 2002. Only the fast part of force and velocity counts, because a scene may push the hand along slowly.

#include <glm/vec3.hpp>

#include "device/stylus.h"

namespace palpate::device {

struct EnergyLimits {
  double corner = 20;           ///< Hz: below this the scene itself may give energy to the hand
  double memory = 0.1;          ///< s: how long generated energy counts
  double tolerated = 10e-6;     ///< J generated within the memory: no damping up to this
  double full_damping = 50e-6;  ///< J at which the damping is `most_damping`
  double most_damping = 3;      ///< N s/m: more damping would itself cause ringing
};

struct EnergyState {
  bool started = false;
  double time = 0;        ///< s
  Vec3 position{0};       ///< m
  Vec3 velocity{0};       ///< m/s, low-passed over two samples
  Vec3 slow_velocity{0};  ///< m/s, below the corner
  Vec3 slow_force{0};     ///< N
  Vec3 force{0};          ///< N: the force requested in the previous tick
  double generated = 0;   ///< J in the fast band, which decays over the memory; below zero if the wall has taken energy
};

/// The force with damping added. Call it in every tick, before the safety filter. No allocation, lock or exception.
Vec3 damp_ringing(const EnergyLimits& limits, const Reading& reading, const Vec3& force, EnergyState& state) noexcept;

}  // namespace palpate::device
