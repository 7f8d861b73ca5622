#include "plugin/paraview/client/views/castable.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>

namespace palpate::plugin {

bool can_be_cast(vtkImageData& image) {
  vtkDataArray* const values = image.GetPointData()->GetScalars();
  if (!values || values->GetNumberOfComponents() != 1) return false;
  if (values->GetDataTypeSize() <= 2) return true;
  // Of other numbers VTK makes 32 768 steps from the least to the greatest, and where they are flat it looks three
  // voxels ahead, also of the coarse ones.
  constexpr double most_range = 1e6;
  constexpr int fewest_voxels = 8;
  const int* const size = image.GetDimensions();
  const double* const range = values->GetRange(0);
  return range[0] <= range[1] && range[1] - range[0] < most_range &&
         std::min({size[0], size[1], size[2]}) >= fewest_voxels;
}

}  // namespace palpate::plugin
