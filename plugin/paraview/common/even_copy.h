#pragma once

#include <array>

#include "plugin/paraview/common/display_image.h"

class vtkDataArray;

namespace palpate::plugin {

/// The volume on the even lattice of `grid` within `extent`, linear between slices. Inside a gap it has the least value
/// of the scan, so that the gap can be seen. `array` has the voxels' type and the size of the extent.
void copy_evenly(const io::Volume& volume, const DisplayGrid& grid, const std::array<int, 6>& extent,
                 vtkDataArray& array);

}  // namespace palpate::plugin
