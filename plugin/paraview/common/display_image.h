#pragma once

/// How a volume is shown: a vtkImageData in patient space (LPS, mm). An oblique scan has its orientation, one under
/// gantry tilt its shear in the DirectionMatrix: nothing is resampled. An image cannot have unevenly spaced slices:
/// they are shown as an evenly spaced copy. The stylus feels the volume itself.

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <string>

#include "io/volume.h"

class vtkImageData;

namespace palpate::plugin {

/// The lattice of the image: position(i, j, k) = origin + spacing[0] i direction_i + spacing[1] j direction_j +
/// spacing[2] k direction_k.
struct DisplayGrid {
  std::array<int, 3> dimensions{};
  std::array<double, 3> spacing_mm{};
  glm::dvec3 origin_mm{0};
  glm::dvec3 direction_i{1, 0, 0};
  glm::dvec3 direction_j{0, 1, 0};
  glm::dvec3 direction_k{0, 0, 1};  ///< unit vector from a slice to the next: under gantry tilt not perpendicular
  bool resampled = false;           ///< whether the scan's slices are uneven and this is an even copy's

  bool operator==(const DisplayGrid&) const = default;
};
DisplayGrid display_grid(const io::Geometry& geometry);

/// Whether the DirectionMatrix is the identity, to 1e-6.
bool is_straight(const DisplayGrid& grid);

/// For vtkImageData::SetDirectionMatrix: by rows, its columns the three directions.
std::array<double, 9> direction_matrix(const DisplayGrid& grid);

/// A volume, or a part of one, and where it lies on the grid.
struct Part {
  std::shared_ptr<const io::Volume> volume;
  std::array<int, 6> extent{};  ///< inclusive i, j, k ranges of the grid
  bool on_grid = true;          ///< whether every voxel is a point of the grid; false if slices are uneven or lost
};
Part whole_part(const std::shared_ptr<const io::Volume>& volume, const DisplayGrid& grid);

bool contains(const std::array<int, 6>& outer, const std::array<int, 6>& inner);

/// Fills `image` with the voxels of the part within `extent` (inclusive i, j, k ranges, as of vtkImageData), as the
/// active point scalars `name`. Whole slices on the grid are viewed without a copy. All others are copied. They are
/// resampled if the grid is not theirs, for example because some slices could not be decoded.
void show_volume(const Part& part, const DisplayGrid& grid, const std::array<int, 6>& extent, const std::string& name,
                 vtkImageData& image);

}  // namespace palpate::plugin
