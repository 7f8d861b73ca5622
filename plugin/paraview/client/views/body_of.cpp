#include "plugin/paraview/client/views/body_of.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "plugin/paraview/common/body_mask.h"
#include "plugin/paraview/common/value_range.h"

namespace palpate::plugin {
namespace {

/// Reads and writes the voxels where they lie: a CT has a hundred million of them.
template <typename Value>
vtkSmartPointer<vtkImageData> body_in(vtkImageData& image, vtkDataArray& values, const KeepGoing& keep_going) {
  const auto* const from = static_cast<const Value*>(values.GetVoidPointer(0));
  const int* const size = image.GetDimensions();
  const std::ptrdiff_t row = size[0], slice = row * size[1];
  const BodyMask body =
      body_mask([&](int i, int j, int k) { return static_cast<double>(from[k * slice + j * row + i]); },
                {size[0], size[1], size[2]}, {image.GetSpacing()[0], image.GetSpacing()[1], image.GetSpacing()[2]},
                Rim::one_voxel, 2, keep_going);
  if (!body.left_something) return nullptr;
  const auto kept = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(values.GetDataType()));
  kept->SetName(values.GetName());
  kept->SetNumberOfTuples(values.GetNumberOfTuples());
  auto* const to = static_cast<Value*>(kept->GetVoidPointer(0));
  const auto least = static_cast<Value>(values.GetRange(0)[0]);
  const std::ptrdiff_t step = body.step.x;
  for (int k = 0; k < size[2]; ++k) {
    check_wanted(keep_going);
    for (int j = 0; j < size[1]; ++j) {
      const std::ptrdiff_t first = k * slice + j * row;
      std::copy_n(from + first, row, to + first);
      for (std::ptrdiff_t i = 0; i < row; i += step) {
        if (!body.holds(static_cast<int>(i), j, k)) std::fill_n(to + first + i, std::min(step, row - i), least);
      }
    }
  }
  keep_range(*kept);
  auto cut = vtkSmartPointer<vtkImageData>::New();
  cut->CopyStructure(&image);
  cut->GetPointData()->SetScalars(kept);
  return cut;
}

}  // namespace

vtkSmartPointer<vtkImageData> body_of(vtkImageData& image, const KeepGoing& keep_going) {
  vtkDataArray* const values = image.GetPointData()->GetScalars();
  if (!values || values->GetNumberOfComponents() != 1) return nullptr;
  switch (values->GetDataType()) { vtkTemplateMacro(return body_in<VTK_TT>(image, *values, keep_going)); }
  return nullptr;
}

}  // namespace palpate::plugin
