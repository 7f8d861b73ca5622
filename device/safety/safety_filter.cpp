#include "device/safety/safety_filter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "device/messages.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

void latch(SafetyState& state, Fault fault) {
  if (state.fault == Fault::none) state.fault = fault;
  state.armed = false;
}

/// Each a number, and none negative.
bool are_limits(const SafetyLimits& limits) {
  for (const double limit : {limits.force, limits.device_force, limits.slew, limits.slew_time, limits.ramp_time,
                             limits.fall_time, limits.speed, limits.speed_smoothing_time, limits.force_age,
                             limits.pose_age, limits.stall_time, limits.heartbeat_time}) {
    if (!(limit >= 0)) return false;
  }
  return true;
}

void fall_at_once(SafetyState& state) {
  state.gain = 0;
  state.slewed_force = Vec3(0);
}

void follow_pose(const SafetyLimits& limits, const SafetyInput& input, SafetyState& state) {
  if (!input.reading.fresh) return;
  const double elapsed = input.time - state.pose_time;
  if (state.has_pose && elapsed > 0) {
    const Vec3 velocity = (input.reading.position - state.pose) / elapsed;
    state.velocity += (velocity - state.velocity) * (elapsed / (elapsed + limits.speed_smoothing_time));
  }
  // Two poses in one instant tell no speed: the older stays the reference.
  if (!state.has_pose || elapsed > 0) {
    state.pose = input.reading.position;
    state.pose_time = input.time;
    state.has_pose = true;
  }
}

bool can_push(State device) {
  return device == State::idle || device == State::ramping || device == State::active;
}

Fault find_fault(const SafetyLimits& limits, const SafetyInput& input, const SafetyState& state) {
  if (!can_push(input.device) && input.device != State::homing) return Fault::device_lost;
  // Written so that a time that is not a number is a fault, too.
  if (!(input.time - state.time <= limits.stall_time)) return Fault::tick_late;
  if (!(input.time - state.pose_time <= limits.stall_time)) return Fault::device_silent;
  if (!(input.time - input.force_time <= limits.stall_time)) return Fault::force_stale;
  if (!(glm::length(state.velocity) <= limits.speed)) return Fault::speed_exceeded;
  if (!(input.time - input.heartbeat_time <= limits.heartbeat_time)) return Fault::commander_silent;
  return Fault::none;
}

void move_gain(const SafetyLimits& limits, double elapsed, SafetyState& state) {
  if (state.armed) {
    state.gain = std::min(1.0, state.gain + elapsed / limits.ramp_time);
  } else {
    state.gain = std::max(0.0, state.gain - elapsed / limits.fall_time);
  }
}

State state_of(const SafetyInput& input, const SafetyState& state) {
  if (state.fault != Fault::none) return State::fault;
  if (!can_push(input.device)) return input.device;
  if (!state.armed) return State::idle;
  return state.gain < 1 ? State::ramping : State::active;
}

}  // namespace

const char* name_of(Fault fault) {
  switch (fault) {
    case Fault::none:
      return "none";
    case Fault::pose_not_finite:
      return "pose not finite";
    case Fault::force_not_finite:
      return "force not finite";
    case Fault::device_lost:
      return "device lost";
    case Fault::device_silent:
      return "device silent";
    case Fault::force_stale:
      return "force stale";
    case Fault::tick_late:
      return "tick late";
    case Fault::speed_exceeded:
      return "speed exceeded";
    case Fault::commander_silent:
      return "commander silent";
  }
  return "unknown";
}

Text advice_for(Fault fault) {
  switch (fault) {
    case Fault::none:
      return {};
    case Fault::pose_not_finite:
      return say("stylus-reported-a-pose-that-cannot");
    case Fault::force_not_finite:
      return say("scene-asked-for-a-force");
    case Fault::device_lost:
      return say("stylus-is-gone");
    case Fault::device_silent:
      return say("stylus-stopped-sending-poses");
    case Fault::force_stale:
      return say("no-new-force-was-computed");
    case Fault::tick_late:
      return say("servo-loop-was-held-up");
    case Fault::speed_exceeded:
      return say("stylus-moved-faster-than-allowed");
    case Fault::commander_silent:
      return say("panel-stopped-answering");
  }
  return {};
}

SafetyResult filter_force(const SafetyLimits& limits, const SafetyInput& input, SafetyState& state) noexcept {
  if (!state.started) {
    state.started = true;
    state.time = state.pose_time = input.time;
  }
  if (!are_limits(limits)) {
    latch(state, Fault::force_not_finite);
    fall_at_once(state);
    return {.state = state_of(input, state), .fault = state.fault};
  }
  const bool pose_is_finite = is_finite(input.reading.position);
  const bool force_is_finite = is_finite(input.force);
  if (!pose_is_finite || !force_is_finite) {
    latch(state, pose_is_finite ? Fault::force_not_finite : Fault::pose_not_finite);
    fall_at_once(state);
  }
  if (pose_is_finite) follow_pose(limits, input, state);

  // Encoders jump when a device is homed, and nothing that was felt before means anything after.
  if (!can_push(input.device)) {
    fall_at_once(state);
    state.has_pose = false;
    state.velocity = Vec3(0);
  }
  // An unarmed filter has nothing to take away: a device that is unplugged or moved fast then is no fault.
  if (state.armed) {
    const Fault fault = find_fault(limits, input, state);
    if (fault != Fault::none) latch(state, fault);
  }

  SafetyResult result;
  const bool fresh =
      input.time - input.force_time <= limits.force_age && input.time - state.pose_time <= limits.pose_age;
  const Vec3 wanted = fresh && pose_is_finite && force_is_finite && can_push(input.device) ? input.force : Vec3(0);
  const Vec3 clamped = clamp_length(wanted, limits.force);
  // A tick that comes late may not use the time that it missed to make a step.
  const double elapsed = input.time > state.time ? std::min(input.time - state.time, limits.force_age) : 0;
  const double slew_time = std::min(elapsed, limits.slew_time);
  const Vec3 change = clamp_length(clamped - state.slewed_force, limits.slew * slew_time);
  result.clamped = clamped != wanted;
  result.slewed = change != clamped - state.slewed_force;
  const Vec3 slewed = result.slewed ? state.slewed_force + change : clamped;
  // A fall never grows, wherever the hand goes meanwhile.
  state.slewed_force = state.armed ? slewed : clamp_length(slewed, glm::length(state.slewed_force));
  move_gain(limits, elapsed, state);
  // What an old pose or force took away comes back along the ramp.
  if (!fresh && state.slewed_force == Vec3(0)) state.gain = 0;
  const Vec3 ramped = state.gain * state.slewed_force;
  result.force = clamp_length(ramped, limits.device_force);
  result.clamped = result.clamped || result.force != ramped;
  if (!is_finite(ramped)) {  // only limits of 1e307 or more lead here
    latch(state, Fault::force_not_finite);
    fall_at_once(state);
    result.force = Vec3(0);
  }

  state.time = input.time;
  result.state = state_of(input, state);
  result.fault = state.fault;
  result.speed = glm::length(state.velocity);
  result.gain = state.gain;
  return result;
}

bool arm(SafetyState& state) noexcept {
  if (state.fault != Fault::none) return false;
  if (!state.armed) {
    state.armed = true;
    // Ages and speed count from now: what happened while nothing was pushed does not matter.
    state.started = false;
    state.has_pose = false;
    state.velocity = Vec3(0);
  }
  return true;
}

void disarm(SafetyState& state) noexcept {
  state.armed = false;
}

void clear_fault(SafetyState& state) noexcept {
  state.fault = Fault::none;
  state.armed = false;
}

}  // namespace palpate::device
