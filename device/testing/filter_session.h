#pragma once

/// The safety filter tick by tick, with only the conditions that a test sets.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "device/safety/safety_filter.h"

namespace palpate::device {

inline constexpr double tick = 1e-3;  ///< s

/// No limits: the output is the input as soon as the filter is armed.
inline SafetyLimits without_limits() {
  return {.force = 1e9,
          .device_force = 1e9,
          .slew = 1e12,
          .slew_time = 1e9,
          .ramp_time = 1e-9,
          .fall_time = 1e-9,
          .speed = 1e9,
          .force_age = 1e9,
          .pose_age = 1e9,
          .stall_time = 1e9,
          .heartbeat_time = 1e9};
}

/// A filter, and its input at each tick.
struct FilterSession {
  SafetyLimits limits = without_limits();
  SafetyState state;
  SafetyInput input;
  bool new_pose = true, new_force = true, alive = true;

  SafetyResult step(double elapsed = tick) {
    input.time += elapsed;
    input.reading.fresh = new_pose;
    if (new_force) input.force_time = input.time;
    if (alive) input.heartbeat_time = input.time;
    return filter_force(limits, input, state);
  }
  SafetyResult run(double seconds) {
    SafetyResult result;
    for (int n = 0; n < std::lround(seconds / tick); ++n) result = step();
    return result;
  }
  /// With the limits of a session, after a first tick.
  static FilterSession with_defaults(const Vec3& force) {
    FilterSession session;
    session.limits = {};
    session.input.force = force;
    session.step();
    return session;
  }
  /// Arms the filter and ramps up until the whole force is applied.
  void push(const Vec3& force) {
    input.force = force;
    step();
    arm(state);
    step();
    ASSERT_LT(glm::length(step().force - force), 1e-12) << "something limits that should not";
  }
};

/// A random direction, with a length between these, N.
inline Vec3 any_force(std::mt19937& random, double least, double most) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(Vec3(x, y, z)) * std::uniform_real_distribution<double>(least, most)(random);
}

}  // namespace palpate::device
