#pragma once

/// Which slices of a scan a stylus can reach.

#include "io/fields/field_options.h"
#include "io/geometry.h"
#include "modes/scene/plan.h"

namespace palpate::modes {

/// The slices that a place within this distance from a device's origin along each of its axes lies in or between;
/// none (last < first) where it meets no part of the scan. No more than these hold a field that is read there.
io::SliceRange slices_within_reach(const io::Geometry& geometry, const Workspace& workspace, const Vec3& half_extent_m);

/// Leaves out of a plan the slices that no proxy of a device of this reach comes to: plan.slices, and what is said of
/// them. The proxy goes no farther from the probe than all modes together can hold it.
void leave_out_slices(const io::Geometry& geometry, const Vec3& half_extent_m, Plan& plan);

}  // namespace palpate::modes
