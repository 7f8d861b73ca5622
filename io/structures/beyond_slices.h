#pragma once

#include "io/structures/distance_field.h"
#include "io/structures/mask.h"

namespace palpate::io {

/// Whether a point lies between the scan's first and last slice, or within half a slice of them; true without a scan.
bool is_seen(const DistanceOptions& options, const Vec3& position_mm);

/// Puts empty slices, which a segmentation leaves out, back before and after the mask, as far as the field reads them.
/// Not where the scan ends with the mask: there nobody has seen whether the structure goes on.
void add_empty_slices(const DistanceOptions& options, Mask& mask);

}  // namespace palpate::io
