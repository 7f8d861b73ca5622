#pragma once

/// The safety filter. Every force passes through it on its way to a device, whichever device it is.
///
/// In this order: finite -> armed -> fresh -> speed -> length clamped, direction kept -> slew -> ramp -> device's
/// limit. A force comes out only while the user has armed the filter and the device is ready. A fault is latched with
/// its cause. From then on the force only becomes smaller, in whatever direction, and is zero within
/// SafetyLimits::fall_time, or at once if pose or force is not a number. The force comes back when the user has cleared
/// the fault and armed again.

#include <cstdint>
#include <glm/vec3.hpp>

#include "device/safety/safety_limits.h"
#include "device/stylus.h"
#include "solver/text/message.h"

namespace palpate::device {

/// The reason for which the force was taken away.
enum class Fault : std::uint8_t {
  none,
  pose_not_finite,
  force_not_finite,
  device_lost,       ///< the stylus reported State::fault or State::disconnected while armed
  device_silent,     ///< no new pose for SafetyLimits::stall_time
  force_stale,       ///< no new force for SafetyLimits::stall_time
  tick_late,         ///< the filter itself was not called for SafetyLimits::stall_time
  speed_exceeded,    ///< the hand was faster than SafetyLimits::speed
  commander_silent,  ///< the controlling thread gave no sign of life for SafetyLimits::heartbeat_time
};
const char* name_of(Fault fault);
/// A sentence that says what happened and what the user can do; empty without a fault.
Text advice_for(Fault fault);

struct SafetyInput {
  double time = 0;             ///< s, never decreasing: now
  Reading reading;             ///< what the stylus returned in this tick
  State device = State::idle;  ///< Stylus::state(); only idle, ramping and active give a force
  Vec3 force{0};               ///< N: requested
  double force_time = 0;       ///< s, same clock as `time`: when that force was computed
  double heartbeat_time = 0;   ///< s, same clock: the last sign of life of the controlling thread
};

struct SafetyResult {
  Vec3 force{0};              ///< N: the force that may be written
  State state = State::idle;  ///< idle (not armed), homing, ramping, active, fault, disconnected
  Fault fault = Fault::none;  ///< latched
  double speed = 0;           ///< m/s, low-passed
  double gain = 0;            ///< 0 to 1: the ramp
  bool clamped = false;       ///< the force was longer than a limit
  bool slewed = false;        ///< the force changed faster than the limit
};

/// What the filter keeps from tick to tick. A plain value: SafetyState{} starts over.
struct SafetyState {
  bool armed = false;
  Fault fault = Fault::none;
  double gain = 0;
  Vec3 slewed_force{0};  ///< N: before the ramp
  double time = 0;       ///< s: of the previous call
  bool started = false;  ///< whether `time` holds
  double pose_time = 0;  ///< s: of the newest pose
  Vec3 pose{0};          ///< m
  bool has_pose = false;
  Vec3 velocity{0};  ///< m/s, low-passed
};

/// Changes `state` and nothing else. No allocation, lock, log, exception or system call.
SafetyResult filter_force(const SafetyLimits& limits, const SafetyInput& input, SafetyState& state) noexcept;

/// Called when the user arms the stylus: forces are ramped up from now on. False, and nothing changes, with a fault.
bool arm(SafetyState& state) noexcept;
/// The force falls to zero within SafetyLimits::fall_time.
void disarm(SafetyState& state) noexcept;
/// Forgets the fault; the filter stays disarmed.
void clear_fault(SafetyState& state) noexcept;

}  // namespace palpate::device
