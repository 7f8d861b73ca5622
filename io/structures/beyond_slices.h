#pragma once

#include "io/structures/distance_field.h"
#include "io/structures/mask.h"

namespace palpate::io {

/// Whether a point lies between the scan's first and last slice, or within half a slice of them; true without a scan.
bool is_seen(const DistanceOptions& options, const Vec3& position_mm);

/// Adds the empty slices before and after the mask that a segmentation leaves out, as far as the field reads them. Not
/// at an end of the mask that is also the scan's end: whether the structure goes on there is unknown.
void add_empty_slices(const DistanceOptions& options, Mask& mask);

}  // namespace palpate::io
