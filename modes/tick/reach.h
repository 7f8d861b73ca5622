#pragma once

/// The slices of a scan that a stylus can reach.

#include "io/fields/field_options.h"
#include "io/geometry.h"
#include "modes/scene/plan.h"

namespace palpate::modes {

/// The slices that are needed to sample all fields in the box that reaches this far from a device's origin along each
/// of its axes; none (last < first) if no part of the scan is in that box.
io::SliceRange slices_within_reach(const io::Geometry& geometry, const Workspace& workspace, const Vec3& half_extent_m);

/// Limits plan.slices to those that the proxy can reach with such a device, and lists the others in plan.left_out. All
/// modes together limit how far the proxy can be from the probe.
void leave_out_slices(const io::Geometry& geometry, const Vec3& half_extent_m, Plan& plan);

}  // namespace palpate::modes
