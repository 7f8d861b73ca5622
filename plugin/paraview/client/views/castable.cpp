#include "plugin/paraview/client/views/castable.h"

#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "plugin/paraview/common/value_range.h"

namespace palpate::plugin {
namespace {

bool is_measured(float value) {
  return std::isfinite(value) && value != std::numeric_limits<float>::lowest();
}

std::span<float> values_of(vtkFloatArray& array) {
  return {array.GetPointer(0), static_cast<std::size_t>(array.GetNumberOfValues())};
}

}  // namespace

bool can_be_cast(vtkImageData& image) {
  vtkDataArray* const values = image.GetPointData()->GetScalars();
  if (!values || values->GetNumberOfComponents() != 1) return false;
  if (values->GetDataTypeSize() <= 2) return true;
  // VTK maps wider numbers to 32 768 steps from the least to the greatest, and in flat regions it reads three voxels
  // ahead, also on the coarse volume.
  constexpr double most_range = 1e6;
  constexpr int fewest_voxels = 8;
  const int* const size = image.GetDimensions();
  const double* const range = values->GetRange(0);
  return range[0] <= range[1] && range[1] - range[0] < most_range &&
         std::min({size[0], size[1], size[2]}) >= fewest_voxels;
}

vtkSmartPointer<vtkImageData> of_numbers_alone(vtkImageData& image) {
  auto* const values = vtkFloatArray::SafeDownCast(image.GetPointData()->GetScalars());
  if (!values || std::ranges::all_of(values_of(*values), is_measured)) return &image;
  auto filled = vtkSmartPointer<vtkFloatArray>::New();
  filled->SetNumberOfComponents(values->GetNumberOfComponents());
  filled->SetNumberOfTuples(values->GetNumberOfTuples());
  const auto least = static_cast<float>(values->GetRange(0)[0]);
  std::ranges::transform(values_of(*values), values_of(*filled).begin(),
                         [least](float value) { return is_measured(value) ? value : least; });
  keep_range(*filled);
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->CopyStructure(&image);
  copy->GetPointData()->SetScalars(filled);
  return copy;
}

}  // namespace palpate::plugin
