#pragma once

#include "io/structures/distance_field.h"
#include "io/structures/mask.h"

namespace palpate::io {

/// Whether a point is between the scan's first and last slice, or within half a slice of them; true without a scan.
bool is_seen(const DistanceOptions& options, const Vec3& position_mm);

/// Adds empty slices, which a segmentation leaves out, before and after the mask, as far as the field reads them. Not
/// where the scan ends with the mask: there it is unknown whether the structure goes on.
void add_empty_slices(const DistanceOptions& options, Mask& mask);

}  // namespace palpate::io
