#pragma once

/// The boundary that holds the proxy now: its name, its strength there, and the uncertainty of its position.

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "modes/scene/site_map.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

/// The surface of the plan that pushes most in a tick, as an index into the scene's modes. None if no surface pushes
/// with more than 0.05 N.
std::optional<std::size_t> holding_surface(std::span<const PrimitiveRecord> shares, const modes::Plan& plan);

/// The uncertainty of the position of a mode's boundary there, mm. None for a structure's edge, which a person has
/// outlined, and where known_to_mm() in summary.h gives none.
std::optional<double> known_to_mm(const PreparedScene& felt, const modes::Scene& scene, std::size_t mode,
                                  const glm::dvec3& place_mm);

/// The same for each tick of a recording that uses this scene, for the boundary that holds the proxy. NaN if no
/// boundary does, if it is unknown, or while the scene changes. Takes some 150 samples, unless the proxy has moved by
/// less than 0.02 mm since the latest ones: not for the tick. For one thread.
std::function<double(const TickRecord&, std::span<const PrimitiveRecord>)> known_to_of_ticks(const PreparedScene& felt,
                                                                                             const modes::Scene& scene);

struct HeldBoundary {
  std::size_t mode = 0;               ///< index into the scene's modes
  std::string name;                   ///< of the mode; or of the site where it is met, if known: "Skin"
  double strength_n = 0;              ///< the largest force on the way in: strength_ahead_n()
  double full_strength_n = 0;         ///< the largest force of its transfer function
  std::optional<double> known_to_mm;  ///< as in known_to_mm()
};

/// None if nothing holds the proxy. Takes some 150 samples: for a picture, not for a tick. `sites`: of the scan;
/// ignored if null or of another scan.
std::optional<HeldBoundary> held_boundary(std::span<const PrimitiveRecord> shares, const PreparedScene& felt,
                                          const modes::Scene& scene, const glm::dvec3& proxy_mm,
                                          const glm::dvec3& probe_mm, const modes::SiteMap* sites = nullptr);

/// "skin, known to ±0.2 mm; 0.31 of its 2.5 N: thin or faint there".
std::string in_words(const HeldBoundary& held);

}  // namespace palpate::plugin
