#pragma once

/// The boundary that holds the proxy right now: which it is, what it takes there, and how well its place is known.

#include <optional>
#include <span>
#include <string>

#include "plugin/session/scan.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

/// The surface of the plan that pushes most in a frame, by its index among the scene's modes; none where none pushes
/// with more than 0.05 N.
std::optional<std::size_t> holding_surface(std::span<const PrimitiveRecord> shares, const modes::Plan& plan);

struct HeldBoundary {
  std::size_t mode = 0;               ///< index into the scene's modes
  double strength_n = 0;              ///< the most that it takes on the next 3 mm of the way in
  double full_strength_n = 0;         ///< the most that its transfer function gives
  std::optional<double> known_to_mm;  ///< as known_to_mm() in summary.h has it
};

/// None where nothing holds the proxy. Some 150 samples: for a picture, not for a tick.
std::optional<HeldBoundary> held_boundary(std::span<const PrimitiveRecord> shares, const PreparedScene& felt,
                                          const modes::Scene& scene, const glm::dvec3& proxy_mm,
                                          const glm::dvec3& probe_mm);

/// "skin, known to ±0.2 mm; 0.31 of its 2.5 N: thin or faint there".
std::string in_words(const HeldBoundary& held, const modes::Scene& scene);

}  // namespace palpate::plugin
