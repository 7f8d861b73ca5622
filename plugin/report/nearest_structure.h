#pragma once

/// Which of a scene's structures matters most at a tick.

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

/// The structure that the proxy is farthest inside the margin of; if the proxy is in no margin, the one whose edge is
/// nearest. `structures`: those of the scene that the tick has distances of, in the same order. None if there are none.
std::optional<NearestStructure> nearest_structure(const TickRecord& tick, const modes::Scene& scene,
                                                  std::span<const std::size_t> structures);

}  // namespace palpate::plugin
