#pragma once

#include "io/structures/distance_field.h"

namespace palpate::io {

/// Whether a point is no more than half a voxel beyond the scan's voxel centers along the scan's axis that is nearest
/// to the normal (of oblique planes, that one alone); true without a scan. Beside the scan nothing is seen either, but
/// planes there still end where others do.
bool is_seen(const DistanceOptions& options, const Vec3& position_mm, const Vec3& normal);

}  // namespace palpate::io
