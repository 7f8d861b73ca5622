#include "plugin/paraview/server/module/pieces.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "plugin/paraview/common/shared_voxels.h"

namespace palpate::plugin {

using Pipeline = vtkStreamingDemandDrivenPipeline;

int pieces_of(vtkInformation& output) {
  return output.Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) ? output.Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) : 1;
}

int ghosts_of(vtkInformation& output) {
  const bool asked = output.Has(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS());
  return asked ? output.Get(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS()) : 0;
}

void ask_for_ghosts(vtkInformation& input, vtkInformation& output, int more) {
  input.Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), ghosts_of(output) + more);
}

std::array<int, 6> own_extent(vtkImageData& image, int ghosts) {
  std::array<int, 6> extent{};
  image.GetExtent(extent.data());
  vtkUnsignedCharArray* const flags = image.GetCellGhostArray();
  if (!flags || flags->GetNumberOfValues() == 0) return extent;
  // Cells that are not ghosts are a box: the first and the last of them are its corners.
  const auto begin = flags->GetPointer(0);
  const auto end = begin + flags->GetNumberOfValues();
  const auto is_own = [](unsigned char flag) { return (flag & vtkDataSetAttributes::DUPLICATECELL) == 0; };
  const auto first = std::find_if(begin, end, is_own);
  if (first == end) return extent;
  const auto last = std::find_if(std::reverse_iterator(end), std::reverse_iterator(begin), is_own).base() - 1;
  std::array<std::ptrdiff_t, 2> at{first - begin, last - begin};
  std::array<int, 6> own = extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::ptrdiff_t cells = std::max(extent[2 * axis + 1] - extent[2 * axis], 1);
    const auto low = static_cast<int>(at[0] % cells);
    const auto high = static_cast<int>(at[1] % cells);
    own[2 * axis] = std::max(extent[2 * axis] + low - ghosts, extent[2 * axis]);
    own[2 * axis + 1] = std::min(extent[2 * axis] + high + 1 + ghosts, extent[2 * axis + 1]);
    at = {at[0] / cells, at[1] / cells};
  }
  return own;
}

void remove_ghost_marks(vtkImageData& image) {
  if (image.HasAnyBlankPoints() || image.HasAnyBlankCells()) return;  // these are marks of another kind
  image.GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  image.GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
}

void cut_to(const std::array<int, 6>& extent, vtkImageData& image) {
  std::array<int, 6> whole{};
  image.GetExtent(whole.data());
  if (extent == whole) return;
  vtkDataArray* const scalars = image.GetPointData()->GetScalars();
  vtkSmartPointer<vtkDataArray> part;
  if (scalars && std::equal(extent.begin(), extent.begin() + 4, whole.begin())) {
    const auto points_until = [&](int slice) {
      const int* const size = image.GetDimensions();
      return static_cast<std::size_t>(slice - whole[4]) * static_cast<std::size_t>(size[0]) *
             static_cast<std::size_t>(size[1]);
    };
    const std::size_t first = points_until(extent[4]);
    part = share_part(*scalars, first, points_until(extent[5] + 1) - first);
  }
  if (part) image.GetPointData()->SetScalars(nullptr);
  // Cropping copies point by point and cell by cell, arrays or none.
  if (part && image.GetPointData()->GetNumberOfArrays() == 0 && image.GetCellData()->GetNumberOfArrays() == 0) {
    image.SetExtent(extent[0], extent[1], extent[2], extent[3], extent[4], extent[5]);
  } else {
    image.Crop(extent.data());
  }
  if (part) image.GetPointData()->SetScalars(part);
}

}  // namespace palpate::plugin
