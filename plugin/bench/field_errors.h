#pragma once

/// The accuracy of a scan's gradient: the errors of its direction and magnitude on phantoms with known answers, and the
/// jitter of its direction on a real scan.

#include <filesystem>
#include <memory>

#include "io/volume.h"

namespace palpate::plugin {

/// For each type of voxels, noise and method: errors at a ball's surface. Also writes gradient_errors.csv into the
/// folder, unless its path is empty.
void tabulate_gradient_errors(const std::filesystem::path& folder);

/// The change of the direction under a hand's tremor of 0.05 mm, at boundaries; direction_jitter.csv.
void tabulate_direction_jitter(const std::shared_ptr<const io::Volume>& volume, const std::filesystem::path& folder);

}  // namespace palpate::plugin
