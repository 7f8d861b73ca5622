#pragma once

/// Which slices of a scan a stylus can reach.

#include <utility>
#include <vector>

#include "palpate/io/geometry.h"
#include "palpate/modes/workspace.h"

namespace palpate::modes {

/// Runs of slices (first, last) that lie wholly outside a device that reaches half_extent_m from its origin along each
/// of its axes: nothing of them can be touched, so nothing of them is ever sampled. Ascending.
std::vector<std::pair<int, int>> slices_out_of_reach(const io::Geometry& geometry, const Workspace& workspace,
                                                     const Vec3& half_extent_m);

}  // namespace palpate::modes
