#pragma once

/// Filtered volumes: OpenCV's filters on a scan's values.

#include <memory>

#include "io/filter.h"
#include "io/progress.h"
#include "io/volume.h"

namespace palpate::io {

/// The filtered volume: floats on the same voxels, with the raw volume in `filtered_from`. A filtered volume is
/// filtered again from its raw values, never twice. If it already has this filter it is returned unchanged; with no
/// filter the raw volume is returned. Uses all cores; the bits do not depend on their number.
///
/// Padding stays padding. Its neighbors are filtered as if it had the smallest value of its slice. The median,
/// bilateral and non-local means filters work within each slice. The Gaussian also works across slices, by their true
/// distances. No filter reaches across missing slices. Throws std::invalid_argument as validate() does, and for a
/// velocity field. Throws Cancelled.
std::shared_ptr<const Volume> filtered(const std::shared_ptr<const Volume>& volume, const Filter& filter,
                                       const Progress& progress = {});

/// The raw volume of a filtered one; the volume itself if it is not filtered.
std::shared_ptr<const Volume> raw_of(const std::shared_ptr<const Volume>& volume);
/// The filter of a filtered volume; none for any other.
Filter filter_of(const Volume& volume);

/// The same values, with the same bits, for the slices first ... last alone: rescaled values, one slice after the
/// other. `filter` must not be none.
std::vector<float> filtered_slices(const Volume& raw, const Filter& filter, int first, int last);

}  // namespace palpate::io
