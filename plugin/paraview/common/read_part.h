#pragma once

#include <array>

#include "io/progress.h"
#include "io/series.h"
#include "io/volume.h"

namespace palpate::plugin {

/// The voxels of the first frame within `extent` (inclusive i, j, k ranges) as a volume of its own, at the same places
/// in the patient. Slices are read a few at a time and cut to size, so that memory holds only the part and those few.
/// Throws as io::load().
io::Volume read_part(const io::Series& series, const std::array<int, 6>& extent, const io::Progress& progress);

}  // namespace palpate::plugin
