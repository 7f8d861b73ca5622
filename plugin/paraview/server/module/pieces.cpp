#include "pieces.h"

#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

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

}  // namespace palpate::plugin
