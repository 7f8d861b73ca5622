#pragma once

/// The places where a stroke enters and leaves the structures of a scene, with the scan's own edges nearby.

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/structures/scan_edge.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {

/// The scan's own edge is searched this far before and behind a crossing, mm along the stroke.
inline constexpr double scan_edge_within_mm = 5;

struct StructureCrossing {
  std::size_t structure = 0;  ///< index into the scene's structures
  bool entering = true;
  glm::dvec3 place_mm{0};                ///< on the structure's surface, patient space
  double depth_mm = 0;                   ///< of the place along the stroke
  std::optional<io::ScanEdge> own_edge;  ///< the scan's edge along the stroke; none if there is none
};

/// In the order of the stroke, which is straight. Two crossings less than 0.1 mm apart may be missed. Near the border
/// of the scan no edge of the scan is found.
std::vector<StructureCrossing> crossings_along(const glm::dvec3& from_mm, const glm::dvec3& to_mm,
                                               const PreparedScene& felt);

/// "liver entered at depth 12.34 mm; the scan's own edge lies 0.8 mm farther on, known to +-0.3 mm".
std::string in_words(const StructureCrossing& crossing, const modes::Scene& scene);

}  // namespace palpate::plugin
