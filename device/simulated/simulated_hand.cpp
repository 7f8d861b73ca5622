#include "device/simulated/simulated_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/vectors.h"

namespace palpate::device {

namespace {

// The standard library's distributions differ between libraries; a session has to be the same everywhere.
double next_uniform(std::uint64_t& state) {
  // splitmix64: S. Vigna, public domain.
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  z ^= z >> 31U;
  return static_cast<double>(z >> 11U) * 0x1p-53;
}

}  // namespace

Tremor::Tremor(const HandModel& hand) : amplitude_(hand.tremor_rms * std::sqrt(2.0 / sines)) {
  std::uint64_t random = hand.tremor_seed;
  for (auto& axis : axes_) {
    for (int i = 0; i < sines; ++i) {
      // One frequency from each fifth of the band: no two sines so close that they beat slower than a session lasts.
      const double share = (i + next_uniform(random)) / sines;
      const double frequency = hand.tremor_lowest + share * (hand.tremor_highest - hand.tremor_lowest);
      axis[static_cast<std::size_t>(i)] = {2 * std::numbers::pi * frequency,
                                           2 * std::numbers::pi * next_uniform(random)};
    }
  }
}

Vec3 Tremor::operator()(double time) const noexcept {
  Vec3 displacement(0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const Sine& sine : axes_[static_cast<std::size_t>(axis)]) {
      displacement[axis] += std::sin(sine.frequency * time + sine.phase);
    }
  }
  return amplitude_ * displacement;
}

void step_body(const ArmModel& arm, const HandModel& hand, const Vec3& force, const Vec3& target,
               const Vec3& target_velocity, double duration, BodyState& state) noexcept {
  const double inertia =
      arm.mass + hand.mass + duration * (hand.damping + arm.viscous_friction + duration * hand.stiffness);
  const Vec3 pull = hand.stiffness * (target - state.position) + hand.damping * target_velocity;
  Vec3 impulse = (arm.mass + hand.mass) * state.velocity + duration * (force + pull);
  const double size = glm::length(impulse);
  const double friction = duration * arm.coulomb_friction;
  impulse = size <= friction ? Vec3(0) : impulse * (1 - friction / size);
  state.velocity = impulse / inertia;
  state.position += duration * state.velocity;
  for (int axis = 0; axis < 3; ++axis) {
    const double end = arm.half_extent[axis];
    if (std::abs(state.position[axis]) > end) {
      state.position[axis] = std::copysign(end, state.position[axis]);
      state.velocity[axis] = 0;
    }
  }
}

}  // namespace palpate::device
