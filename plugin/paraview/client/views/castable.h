#pragma once

#include <vtkSmartPointer.h>

class vtkImageData;

namespace palpate::plugin {

/// Whether VTK's software ray caster can draw such a scan: it has one number a voxel. Numbers wider than 16 bits must
/// also have a range below 1e6, and at least eight voxels along each axis.
bool can_be_cast(vtkImageData& image);

/// The same image, or a copy if some floats are NaN or mark missing data (the lowest float): these get the least of the
/// other values, because the caster maps values to 15 bits.
vtkSmartPointer<vtkImageData> of_numbers_alone(vtkImageData& image);

}  // namespace palpate::plugin
