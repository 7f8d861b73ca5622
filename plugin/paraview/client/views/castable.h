#pragma once

class vtkImageData;

namespace palpate::plugin {

/// Whether VTK's ray caster for processors draws such a scan: one number a voxel, and of wide numbers neither a
/// boundless range nor fewer than eight voxels along an axis.
bool can_be_cast(vtkImageData& image);

}  // namespace palpate::plugin
