#pragma once

#include <array>

#include "plugin/paraview/common/display_image.h"

class vtkDataArray;

namespace palpate::plugin {

/// The volume on the even lattice of `grid` within `extent`, linear between slices; inside a gap the least value of the
/// scan, so that a gap is seen as one. `array` is of the voxels' type and size.
void copy_evenly(const io::Volume& volume, const DisplayGrid& grid, const std::array<int, 6>& extent,
                 vtkDataArray& array);

}  // namespace palpate::plugin
