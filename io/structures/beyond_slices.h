#pragma once

#include "io/structures/distance_field.h"

namespace palpate::io {

/// Whether the scan covers a point along the one axis of the scan that is nearest to `normal`: whether the point is at
/// most half a voxel beyond the voxel centers. True without a scan. The other two axes are not checked: beside the scan
/// nothing is known either, but the stack of planes ends there at the same height as elsewhere.
bool is_seen(const DistanceOptions& options, const Vec3& position_mm, const Vec3& normal);

}  // namespace palpate::io
