#include "display_image.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <type_traits>
#include <variant>
#include <vector>

#include "even_copy.h"
#include "shared_voxels.h"

namespace palpate::plugin {
namespace {

// The pitch of most slices: those without a gap behind them and without a neighbour too near.
double median_pitch(const io::Geometry& geometry) {
  const auto& slices = geometry.slice_positions;
  std::vector<double> pitches;
  for (std::size_t k = 0; k + 1 < slices.size(); ++k) pitches.push_back(glm::distance(slices[k], slices[k + 1]));
  const auto middle = pitches.begin() + static_cast<std::ptrdiff_t>(pitches.size() / 2);
  std::nth_element(pitches.begin(), middle, pitches.end());
  return *middle;
}

bool has_whole_slices(const std::array<int, 6>& extent, const io::Volume& volume) {
  return extent[0] == 0 && extent[1] == volume.geometry.dimensions.x - 1 && extent[2] == 0 &&
         extent[3] == volume.geometry.dimensions.y - 1;
}

void copy_voxels(const io::Volume& volume, const std::array<int, 6>& extent, vtkDataArray& array) {
  std::visit(
      [&](const auto& voxels) {
        using Stored = typename std::decay_t<decltype(voxels)>::value_type;
        auto* out = static_cast<Stored*>(array.GetVoidPointer(0));
        for (int k = extent[4]; k <= extent[5]; ++k) {
          for (int j = extent[2]; j <= extent[3]; ++j) {
            const auto row = voxels.begin() + static_cast<std::ptrdiff_t>(volume.offset(extent[0], j, k));
            out = std::copy_n(row, extent[1] - extent[0] + 1, out);
          }
        }
      },
      volume.voxels);
}

vtkSmartPointer<vtkDataArray> array_of(const std::shared_ptr<const io::Volume>& volume, const DisplayGrid& grid,
                                       const std::array<int, 6>& extent) {
  const auto length = [&](std::size_t axis) {
    return static_cast<std::size_t>(extent[2 * axis + 1] - extent[2 * axis] + 1);
  };
  const std::size_t count = length(0) * length(1) * length(2);
  const bool voxels_grid = !grid.resampled && grid == display_grid(volume->geometry);
  if (voxels_grid && has_whole_slices(extent, *volume)) {
    return share_voxels(volume, volume->offset(0, 0, extent[4]), count);
  }
  const auto own = vtkSmartPointer<vtkDataArray>::Take(share_voxels(volume, 0, 0)->NewInstance());
  own->SetNumberOfTuples(static_cast<vtkIdType>(count));
  if (voxels_grid) {
    copy_voxels(*volume, extent, *own);
  } else {
    copy_evenly(*volume, grid, extent, *own);
  }
  tie_to_volume(*own, volume);
  return own;
}

}  // namespace

DisplayGrid display_grid(const io::Geometry& geometry) {
  const auto& slices = geometry.slice_positions;
  DisplayGrid grid;
  grid.dimensions = {geometry.dimensions.x, geometry.dimensions.y, geometry.dimensions.z};
  grid.spacing_mm = {geometry.spacing_i, geometry.spacing_j, glm::length(geometry.step)};
  grid.origin_mm = slices.front();
  grid.direction_i = geometry.direction_i;
  grid.direction_j = geometry.direction_j;
  grid.direction_k = glm::normalize(geometry.step);
  grid.resampled = !geometry.uniform && slices.size() > 1;
  if (grid.resampled) {
    const double length = glm::distance(slices.front(), slices.back());
    const double most = 4 * static_cast<double>(slices.size());  // a stray pair of slices must not cost gigabytes
    const double steps = std::clamp(std::round(length / median_pitch(geometry)), 1.0, most);
    grid.dimensions[2] = static_cast<int>(steps) + 1;
    grid.spacing_mm[2] = length / steps;
    grid.direction_k = (slices.back() - slices.front()) / length;
  }
  return grid;
}

std::array<double, 9> direction_matrix(const DisplayGrid& grid) {
  const auto &i = grid.direction_i, &j = grid.direction_j, &k = grid.direction_k;
  return {i.x, j.x, k.x, i.y, j.y, k.y, i.z, j.z, k.z};
}

bool is_straight(const DisplayGrid& grid) {
  constexpr std::array<double, 9> identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
  constexpr double visible = 1e-6;
  const auto matrix = direction_matrix(grid);
  return std::equal(matrix.begin(), matrix.end(), identity.begin(),
                    [](double a, double b) { return std::abs(a - b) < visible; });
}

void show_volume(const std::shared_ptr<const io::Volume>& volume, const DisplayGrid& grid,
                 const std::array<int, 6>& extent, const std::string& name, vtkImageData& image) {
  image.SetExtent(std::array<int, 6>(extent).data());
  image.SetSpacing(grid.spacing_mm.data());
  image.SetOrigin(grid.origin_mm.x, grid.origin_mm.y, grid.origin_mm.z);
  image.SetDirectionMatrix(direction_matrix(grid).data());
  if (image.GetNumberOfPoints() == 0) return;  // an MPI rank without a part
  const auto array = array_of(volume, grid, extent);
  array->SetName(name.c_str());
  image.GetPointData()->SetScalars(array);
}

}  // namespace palpate::plugin
