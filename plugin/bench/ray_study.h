#pragma once

/// How much of the bone on straight paths into a scan is felt with the suggested scene: `palpate-bench suggest SERIES
/// --rays`.

#include <memory>
#include <string>

#include "io/volume.h"

namespace palpate::plugin {

/// 20 evenly spread rays from outside to the scan's middle. A passage of bone is at least 0.5 mm above 200 HU with a
/// peak above 300 HU. Prints how often each boundary is crossed, and for CT a line for each type of passage.
void run_ray_study(const std::string& name, const std::shared_ptr<const io::Volume>& volume);

}  // namespace palpate::plugin
