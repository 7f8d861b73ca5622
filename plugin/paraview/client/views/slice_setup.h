#pragma once

/// A plane of an image as its slice view needs it.

#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/slice_view.h"

namespace palpate::plugin {

/// What ParaView's slice representation calls slices across the sight's axis.
int slice_mode(const Sight& sight);
/// The slice and the camera are left to the caller.
SliceSetup setup_of(const ImageLattice& lattice, Plane plane);

}  // namespace palpate::plugin
