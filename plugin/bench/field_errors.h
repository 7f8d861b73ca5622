#pragma once

/// How good the gradient of a scan is: the errors of its direction and magnitude on phantoms with known answers, and
/// how its direction trembles on a real scan.

#include <filesystem>
#include <memory>

#include "io/volume.h"

namespace palpate::plugin {

/// For each kind of voxels, noise and method: errors at a ball's surface. Also gradient_errors.csv in the folder,
/// unless that is empty.
void tabulate_gradient_errors(const std::filesystem::path& folder);

/// How far the direction turns under a hand's tremor of 0.05 mm, where there is a boundary; direction_jitter.csv.
void tabulate_direction_jitter(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder);

}  // namespace palpate::plugin
