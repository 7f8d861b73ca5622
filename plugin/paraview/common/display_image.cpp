#include "plugin/paraview/common/display_image.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/quantile.h"
#include "plugin/paraview/common/even_copy.h"
#include "plugin/paraview/common/shared_voxels.h"
#include "plugin/paraview/common/value_range.h"

namespace palpate::plugin {
namespace {

// The pitch of most slices: those without a gap behind them and without a neighbor too near.
double median_pitch(const io::Geometry& geometry) {
  const auto& slices = geometry.slice_positions;
  std::vector<double> pitches;
  for (std::size_t k = 0; k + 1 < slices.size(); ++k) pitches.push_back(glm::distance(slices[k], slices[k + 1]));
  return io::quantile(std::move(pitches), 0.5);
}

/// Offset in the part's voxels of a point of the grid.
std::size_t offset_in(const Part& part, int i, int j, int k) {
  return part.volume->offset(i - part.extent[0], j - part.extent[2], k - part.extent[4]);
}

void copy_voxels(const Part& part, const std::array<int, 6>& extent, vtkDataArray& array) {
  std::visit(
      [&](const auto& voxels) {
        using Stored = typename std::decay_t<decltype(voxels)>::value_type;
        auto* out = static_cast<Stored*>(array.GetVoidPointer(0));
        for (int k = extent[4]; k <= extent[5]; ++k) {
          for (int j = extent[2]; j <= extent[3]; ++j) {
            const auto row = voxels.begin() + static_cast<std::ptrdiff_t>(offset_in(part, extent[0], j, k));
            out = std::copy_n(row, extent[1] - extent[0] + 1, out);
          }
        }
      },
      part.volume->voxels);
}

vtkSmartPointer<vtkDataArray> array_of(const Part& part, const DisplayGrid& grid, const std::array<int, 6>& extent) {
  const auto length = [&](std::size_t axis) {
    return static_cast<std::size_t>(extent[2 * axis + 1] - extent[2 * axis]) + 1;
  };
  const std::size_t count = length(0) * length(1) * length(2);
  const bool whole_slices = std::equal(extent.begin(), extent.begin() + 4, part.extent.begin());
  if (part.on_grid && whole_slices) {
    return share_voxels(part.volume, offset_in(part, extent[0], extent[2], extent[4]), count);
  }
  auto own = vtkSmartPointer<vtkDataArray>::Take(share_voxels(part.volume, 0, 0)->NewInstance());
  own->SetNumberOfTuples(static_cast<vtkIdType>(count));
  if (part.on_grid) {
    copy_voxels(part, extent, *own);
  } else {
    copy_evenly(*part.volume, grid, extent, *own);
  }
  tie_to_volume(*own, part.volume);
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

Part whole_part(const std::shared_ptr<const io::Volume>& volume, const DisplayGrid& grid) {
  const auto& size = grid.dimensions;
  return {volume,
          {0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1},
          !grid.resampled && grid == display_grid(volume->geometry)};
}

bool contains(const std::array<int, 6>& outer, const std::array<int, 6>& inner) {
  return outer[0] <= inner[0] && inner[1] <= outer[1] && outer[2] <= inner[2] && inner[3] <= outer[3] &&
         outer[4] <= inner[4] && inner[5] <= outer[5];
}

void show_volume(const Part& part, const DisplayGrid& grid, const std::array<int, 6>& extent, const std::string& name,
                 vtkImageData& image) {
  image.SetExtent(std::array<int, 6>(extent).data());
  image.SetSpacing(grid.spacing_mm.data());
  image.SetOrigin(grid.origin_mm.x, grid.origin_mm.y, grid.origin_mm.z);
  image.SetDirectionMatrix(direction_matrix(grid).data());
  if (image.GetNumberOfPoints() == 0) return;  // an MPI rank without a part
  const auto array = array_of(part, grid, extent);
  array->SetName(name.c_str());
  keep_range(*array);
  image.GetPointData()->SetScalars(array);
}

}  // namespace palpate::plugin
