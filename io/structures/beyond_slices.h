#pragma once

#include "io/structures/distance_field.h"
#include "io/structures/mask.h"

namespace palpate::io {

/// Whether a point lies between the scan's first and last slice, or within half a slice of them; true without a scan.
bool is_seen(const DistanceOptions& options, const Vec3& position_mm);

/// A segmentation leaves empty slices out: puts those back that the field sees around the mask's ends. Not where the
/// scan ends too, for there nobody has seen whether the structure goes on.
void add_empty_slices(const DistanceOptions& options, Mask& mask);

}  // namespace palpate::io
