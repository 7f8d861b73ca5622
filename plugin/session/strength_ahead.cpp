#include "plugin/session/strength_ahead.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

namespace palpate::plugin {
namespace {

constexpr double way_mm = 3, step_mm = 0.1;
constexpr double lets_go = 0.5;  // of the force, that a break-through takes away at once

}  // namespace

double strength_against_n(const modes::ActiveMode& mode, const io::Sample& sample, const glm::dvec3& inward) {
  if (!sample.inside) return 0;
  const glm::dvec3 uphill =
      mode.structure < 0 ? sample.gradient : sample.distance[static_cast<std::size_t>(mode.structure)].gradient;
  const double rise = glm::dot(uphill, inward);
  const bool resists = mode.side == modes::Side::both || (mode.side == modes::Side::entering ? rise > 0 : rise < 0);
  return resists ? mode.strength(sample) : 0;
}

double strength_ahead_n(const modes::ActiveMode& mode, const modes::Plan& plan, const io::FieldSource& source,
                        const glm::dvec3& place_mm, const glm::dvec3& inward) {
  const double n_per_mm = plan.stiffness_n_per_m / plan.workspace.mm_per_m;
  // The balance of a slow push: the proxy rests at `way` while the probe is strength / n_per_mm ahead of it.
  double most_n = 0, farthest_probe_mm = -std::numeric_limits<double>::infinity(), reached_mm = 0;
  for (int n = 0; n * step_mm <= way_mm; ++n) {
    const double way = n * step_mm;
    if ((way - reached_mm) * n_per_mm > std::max(lets_go * most_n, step_mm * n_per_mm) && most_n > 0) break;
    const double strength = strength_against_n(mode, source.sample(place_mm + way * inward, plan.fields), inward);
    if (way + strength / n_per_mm >= farthest_probe_mm) {
      farthest_probe_mm = way + strength / n_per_mm;
      reached_mm = way;
    }
    most_n = std::max(most_n, strength);
  }
  return most_n;
}

}  // namespace palpate::plugin
