#pragma once

/// Of the structures that a scene reads, the one that matters most at a frame.

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

/// The one farthest within its margin; where none has the proxy within its margin, the one whose edge is nearest.
/// `structures`: of the scene those that the frame tells of, in that order. None where there are none.
std::optional<NearestStructure> nearest_structure(const TickRecord& frame, const modes::Scene& scene,
                                                  std::span<const std::size_t> structures);

}  // namespace palpate::plugin
