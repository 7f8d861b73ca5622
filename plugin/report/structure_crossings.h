#pragma once

/// Where a stroke goes in and out of the structures that a scene reads, and where the scan's own values have an edge
/// beside.

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/structures/scan_edge.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {

/// mm along the stroke, before and behind a crossing: as far as the scan's own edge is looked for.
inline constexpr double scan_edge_within_mm = 5;

struct StructureCrossing {
  std::size_t structure = 0;  ///< index into the scene's structures
  bool entering = true;
  glm::dvec3 place_mm{0};                ///< on the structure's surface, patient space
  double depth_mm = 0;                   ///< of the place along the stroke
  std::optional<io::ScanEdge> own_edge;  ///< the scan's, along the stroke; none if it shows none there
};

/// In the order of the stroke, which is straight. Two crossings less than 0.1 mm apart may be missed. Where the scan
/// ends no edge of its own is found.
std::vector<StructureCrossing> crossings_along(const glm::dvec3& from_mm, const glm::dvec3& to_mm,
                                               const PreparedScene& felt);

/// "liver entered at depth 12.34 mm; the scan's own edge lies 0.8 mm farther on, known to +-0.3 mm".
std::string in_words(const StructureCrossing& crossing, const modes::Scene& scene);

}  // namespace palpate::plugin
