#pragma once

/// Keeps the stylus out of a structure, or in it. The force begins when the stylus comes nearer to the edge than a
/// margin.
///
/// Two primitives share the strength. A plane resists movement towards the edge, as a surface does; a directed force
/// pushes back by itself. Both rise over the margin, once differentiable, and stay at their maximum beyond the edge:
/// the force is bounded by the strength, continuous, and zero outside the margin. A force is evaluated at the old
/// proxy, so a force that rises as steeply as the coupling's stiffness would oscillate. So the slope of the directed
/// force is limited to half of that stiffness, and the plane takes the rest. The margin is in mm of patient and the
/// coupling in mm of hand, so the workspace's scale matters.

#include <algorithm>
#include <glm/geometric.hpp>

#include "modes/types/direction.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {

/// 0 at the margin, 1 from the edge on; `way_mm`: the distance to the edge, mm, negative beyond it.
inline double keep_part(double way_mm, double margin_mm) noexcept {
  const double t = std::clamp(1.0 - way_mm / margin_mm, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The share of the strength for the directed force. `mm_per_m`: mm of patient for one m of hand.
inline double push_share(const Mode& mode, double stiffness_n_per_m, double mm_per_m) {
  constexpr double steepest = 1.5;  // of keep_part, per margin
  double most_n = mode.strength_n.maximum();
  for (const Gate& gate : mode.gates) {
    most_n *= gate.factor.maximum();
  }
  const double bearable_n = 0.5 * stiffness_n_per_m / mm_per_m * mode.margin_mm / steepest;
  return most_n > 0 ? std::min(0.5, bearable_n / most_n) : 0.0;
}

/// `outward`: 1 pushes away from the structure's inside (keep out), -1 towards it (keep in). In the tick.
inline void place_keep(const ActiveMode& mode, const Place& place, double outward, PrimitiveList& primitives) noexcept {
  const auto n = static_cast<std::size_t>(mode.structure);
  const io::Distance distance = place.sample.distance[n];
  const double way = -outward * distance.mm;
  if (!(way < mode.margin_mm)) {
    return;  // the usual case: the proxy is outside the margin
  }
  const double part = keep_part(way, mode.margin_mm);
  if (!(part > 0)) {
    return;
  }
  const auto inward = unit_in_device(distance.gradient, place.workspace);
  if (!inward) {
    return;  // at the center of the structure: no direction leads away
  }
  const Vec3 direction = -outward * *inward;
  const double strength = part * mode.strength(place.sample);
  // At the center the gradient goes through zero, and the push with it: it does not jump from one side to the other.
  const double steady = std::min(1.0, glm::length(distance.gradient));
  primitives.add(solver::make_directed_force(mode.push_share * steady * strength, direction));
  primitives.add(solver::make_plane((1.0 - mode.push_share) * strength, place.structure_anchor_m[n], direction));
}

}  // namespace palpate::modes
