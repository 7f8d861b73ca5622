#include "plugin/report/nearest_structure.h"

#include <algorithm>
#include <cmath>

namespace palpate::plugin {

std::optional<NearestStructure> nearest_structure(const TickRecord& tick, const modes::Scene& scene,
                                                  std::span<const std::size_t> structures) {
  std::optional<NearestStructure> nearest;
  double margin_left = 0;  // of the nearest
  for (std::size_t n = 0; n < std::min(structures.size(), distance_count); ++n) {
    const double mm = tick.distance_mm[n];
    if (!std::isfinite(mm) || structures[n] >= scene.structures.size()) continue;
    const auto& margin = scene.structures[structures[n]].margin_mm;
    const double left = margin ? -mm - *margin : 0;
    const bool within = margin && left < 0;
    const bool first = !nearest || (within && !nearest->within_margin);
    const bool nearer = nearest && within == nearest->within_margin &&
                        (within ? left < margin_left : std::abs(mm) < std::abs(nearest->distance_mm));
    if (first || nearer) {
      nearest = NearestStructure{.structure = structures[n], .distance_mm = mm, .within_margin = within};
      margin_left = left;
    }
  }
  return nearest;
}

}  // namespace palpate::plugin
