#pragma once

/// The settings of a slice view for a plane of an image.

#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/slice_view.h"

namespace palpate::plugin {

/// ParaView's slice mode for slices perpendicular to the axis of the sight.
int slice_mode(const Sight& sight);
/// The caller sets the slice and the camera.
SliceSetup setup_of(const ImageLattice& lattice, Plane plane);

}  // namespace palpate::plugin
