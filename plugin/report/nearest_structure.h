#pragma once

/// The most relevant of a scene's structures at a tick.

#include <optional>
#include <span>

#include "modes/scene/scene.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

struct NearestStructure {
  std::size_t structure = 0;  ///< index into the scene's
  double distance_mm = 0;     ///< of the proxy, positive inside
  bool within_margin = false;
};

/// The structure in whose margin the proxy is deepest, or the one with the nearest edge if the proxy is in no margin.
/// `structures`: the scene's structures with distances in the tick, in the same order. None if there are none.
std::optional<NearestStructure> nearest_structure(const TickRecord& tick, const modes::Scene& scene,
                                                  std::span<const std::size_t> structures);

}  // namespace palpate::plugin
