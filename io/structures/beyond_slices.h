#pragma once

#include "io/structures/distance_field.h"

namespace palpate::io {

/// Whether a point is within half a voxel of the scan's voxel centers on all three axes; true without a scan.
bool is_seen(const DistanceOptions& options, const Vec3& position_mm);

}  // namespace palpate::io
