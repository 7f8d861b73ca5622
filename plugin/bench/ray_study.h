#pragma once

/// How much of the bone on straight ways into a scan is felt with the suggested scene: `palpate-bench suggest SERIES
/// --rays`.

#include <memory>
#include <string>

#include "io/volume.h"

namespace palpate::plugin {

/// 20 rays from outside to the scan's middle, spread evenly. A passage of bone is a stretch of at least 0.5 mm above
/// 200 HU whose peak is above 300 HU. Prints how often each boundary is crossed, and of a CT a line for each kind of
/// passage.
void run_ray_study(const std::string& name, const std::shared_ptr<const io::Volume>& volume);

}  // namespace palpate::plugin
