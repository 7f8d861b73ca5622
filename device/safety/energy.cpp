#include "device/safety/energy.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "device/vectors.h"

namespace palpate::device {

Vec3 damp_ringing(const EnergyLimits& limits, const Reading& reading, const Vec3& force, EnergyState& state) noexcept {
  if (!is_finite(reading.position) || !is_finite(force)) {
    state = {};
    return force;  // the safety filter's affair
  }
  const double elapsed = reading.time - state.time;
  if (!state.started || elapsed > limits.memory) {
    state = {};
    state.started = true;
    state.time = reading.time;
    state.position = reading.position;
    state.slow_force = state.force = force;
    return force;
  }
  if (reading.fresh && elapsed > 0) {
    const Vec3 velocity = (reading.position - state.position) / elapsed;
    const double share = std::min(1.0, 2 * std::numbers::pi * limits.corner * elapsed);
    state.velocity = 0.5 * (state.velocity + velocity);
    state.slow_velocity += share * (velocity - state.slow_velocity);
    state.slow_force += share * (state.force - state.slow_force);
    const double power = glm::dot(state.force - state.slow_force, velocity - state.slow_velocity);
    state.generated += power * elapsed - state.generated * std::min(1.0, elapsed / limits.memory);
    state.time = reading.time;
    state.position = reading.position;
  }
  state.force = force;
  const double excess = (state.generated - limits.tolerated) / (limits.full_damping - limits.tolerated);
  return force - limits.most_damping * std::clamp(excess, 0.0, 1.0) * (state.velocity - state.slow_velocity);
}

}  // namespace palpate::device
