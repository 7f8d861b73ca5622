#include "device/safety/stiffness.h"

#include <algorithm>
#include <limits>

namespace palpate::device {

StiffnessBounds stiffness_bounds(const RenderingDynamics& dynamics, double configured, double margin) {
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  const double lag = dynamics.period / 2 + dynamics.delay;
  StiffnessBounds bounds;
  bounds.passive = dynamics.device_damping / lag;
  bounds.held = (dynamics.device_damping + dynamics.hand_damping) / lag;
  bounds.near_rest = dynamics.position_step > 0 ? 2 * dynamics.coulomb_friction / dynamics.position_step : unbounded;
  bounds.advised = std::min(configured, std::max(bounds.passive, margin * std::min(bounds.held, bounds.near_rest)));
  return bounds;
}

}  // namespace palpate::device
