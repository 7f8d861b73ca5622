#pragma once

#include <vtkSmartPointer.h>

class vtkImageData;

namespace palpate::plugin {

/// Whether VTK's ray caster for processors draws such a scan: one number a voxel, and of wide numbers neither a
/// boundless range nor fewer than eight voxels along an axis.
bool can_be_cast(vtkImageData& image);

/// The same image; a copy where floats are no numbers or say that nothing was measured (the least float there is):
/// these have the least value of the others, since the caster turns values into 15 bits.
vtkSmartPointer<vtkImageData> of_numbers_alone(vtkImageData& image);

}  // namespace palpate::plugin
