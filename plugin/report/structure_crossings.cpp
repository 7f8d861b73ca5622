#include "plugin/report/structure_crossings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"

namespace palpate::plugin {
namespace {

/// How far along the way the structure's surface is crossed, mm, ascending.
std::vector<double> surface_depths(const io::DistanceField& structure, const glm::dvec3& from, const glm::dvec3& along,
                                   double length) {
  constexpr double step_mm = 0.1, most_steps = 1e6;
  const auto steps = static_cast<int>(std::clamp(std::ceil(length / step_mm), 1.0, most_steps));
  const auto is_inside = [&](double depth) { return structure.sample(from + depth * along).mm > 0; };
  std::vector<double> depths;
  bool inside = is_inside(0);
  for (int n = 1; n <= steps; ++n) {
    const double depth = length * n / steps;
    if (is_inside(depth) == inside) continue;
    double before = length * (n - 1) / steps, behind = depth;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (before + behind);
      (is_inside(middle) == inside ? before : behind) = middle;
    }
    depths.push_back(behind);
    inside = !inside;
  }
  return depths;
}

}  // namespace

std::vector<StructureCrossing> crossings_along(const glm::dvec3& from_mm, const glm::dvec3& to_mm,
                                               const PreparedScene& felt) {
  std::vector<StructureCrossing> crossings;
  if (felt.structures.empty()) return crossings;
  const double length = glm::distance(from_mm, to_mm);
  const glm::dvec3 along = (to_mm - from_mm) / length;
  // The value's own gradient, whatever the scene feels; read once, so without bricks.
  const std::shared_ptr<const io::Volume> scan = io::raw_of(felt.volume);  // what is felt may be filtered
  const io::VolumeFields values(scan, io::FieldSet::value | io::FieldSet::gradient, 1,
                                {.gradient = io::GradientMethod::cubic, .brick_bytes = 0, .background = false});
  for (std::size_t n = 0; n < felt.structures.size(); ++n) {
    const io::DistanceField& distance = *felt.structures[n].distance;
    bool inside = distance.sample(from_mm).mm > 0;
    for (const double depth : surface_depths(distance, from_mm, along, length)) {
      const glm::dvec3 place = from_mm + depth * along;
      crossings.push_back(
          {.structure = felt.plan->structures[n],
           .entering = !inside,
           .place_mm = place,
           .depth_mm = depth,
           .own_edge = io::scan_edge({values, scan->geometry}, distance, place, along, scan_edge_within_mm)});
      inside = !inside;
    }
  }
  std::ranges::stable_sort(crossings, {}, &StructureCrossing::depth_mm);
  return crossings;
}

std::string in_words(const StructureCrossing& crossing, const modes::Scene& scene) {
  std::string words = fmt::format("{} {} at depth {:.2f} mm; ", scene.structures[crossing.structure].name,
                                  crossing.entering ? "entered" : "left", crossing.depth_mm);
  if (!crossing.own_edge) {
    return words + fmt::format("the scan's own values show no edge within {:.0f} mm", scan_edge_within_mm);
  }
  const io::ScanEdge& edge = *crossing.own_edge;
  return words + fmt::format("the scan's own edge lies {:.1f} mm {}, known to +-{:.2g} mm", std::abs(edge.mm),
                             edge.mm < 0 ? "before" : "farther on", edge.known_to_mm);
}

}  // namespace palpate::plugin
