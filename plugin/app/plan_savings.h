#pragma once

/// Measures what leaving parts out of a plan saves on this scan: the time of a step with and without the part, and the
/// memory of both.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/volume.h"
#include "modes/scene/plan.h"

namespace palpate::plugin {

struct Saving {
  std::string what, why;     ///< as in modes::LeftOut
  std::string saves;         ///< in words
  std::optional<double> us;  ///< of a sub-step; empty if it cannot be measured
  std::optional<double> ms;  ///< once, for computing ahead
  std::optional<std::size_t> bytes;
};

/// For every part that the plan of this scene left out. Takes some tenths of a second.
std::vector<Saving> measure_savings(const modes::Scene& scene, const modes::Plan& plan,
                                    const std::shared_ptr<const io::Volume>& volume);

}  // namespace palpate::plugin
