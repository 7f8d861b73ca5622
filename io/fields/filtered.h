#pragma once

/// Filtered volumes: OpenCV's filters on a scan's values.

#include <memory>

#include "io/filter.h"
#include "io/progress.h"
#include "io/volume.h"

namespace palpate::io {

/// The volume through the filter: values as floats, on the same voxels, with `filtered_from` saying what of. What was
/// filtered before is filtered from its raw values, never twice; where it is just this filter's, it is returned as it
/// is, and without a filter the raw volume is. On all cores, with the same bits on any number.
///
/// Padding stays padding; to its neighbors it counts as the smallest value of its slice. The median, bilateral and
/// non-local means filters work in each slice; the Gaussian also along the step from slice to slice, by the slices' own
/// distances. None reaches across missing slices. Throws std::invalid_argument as validate() does and for a velocity
/// field, and Cancelled.
std::shared_ptr<const Volume> filtered(const std::shared_ptr<const Volume>& volume, const Filter& filter,
                                       const Progress& progress = {});

/// The volume that a filtered one was made of; any other is its own.
std::shared_ptr<const Volume> raw_of(const std::shared_ptr<const Volume>& volume);
/// What it was filtered with; none for any other.
Filter filter_of(const Volume& volume);

/// The same of slices first ... last alone, with the same bits: rescaled values, slice by slice.
std::vector<float> filtered_slices(const Volume& raw, const Filter& filter, int first, int last);

}  // namespace palpate::io
