#pragma once

/// A phantom as a scanner would show it: values integrated over each voxel, with noise, on any grid.

#include <cstdint>
#include <vector>

#include "io/volume.h"
#include "testdata/phantom.h"

namespace palpate::testdata {

/// The lattice of voxels. By default 64 voxels of 1 mm along the patient's axes, centered at the origin.
struct Grid {
  glm::ivec3 size{64};        ///< columns, rows, slices
  Vec3 spacing{1};            ///< mm between columns, rows and slices
  Vec3 center{0};             ///< mm: middle of the volume
  Vec3 direction_i{1, 0, 0};  ///< unit
  Vec3 direction_j{0, 1, 0};  ///< unit, perpendicular to direction_i
  /// Gantry tilt: the slices lean by this about direction_i, the table still moves along i x j.
  double tilt_degrees = 0;
  /// Uneven slices: slice k is displaced along the step by uneven_mm * sin(2.4 k).
  double uneven_mm = 0;
  std::vector<int> missing;  ///< slices left out, ascending
};

/// Throws std::invalid_argument if the result is no volume (a size below 1, a spacing not above 0, directions not unit
/// or not perpendicular, displacements that swap slices).
io::Geometry make_geometry(const Grid& grid);

/// Rotates both directions of the grid about an axis (unit): an oblique scan.
Grid rotated(Grid grid, const Vec3& axis, double degrees);

struct Acquisition {
  double noise = 0;            ///< standard deviation, in the phantom's unit; Gaussian, independent by voxel
  std::uint64_t seed = 1;      ///< of the noise; the same seed gives the same noise
  double slice_thickness = 0;  ///< mm along the slices' normal; 0: from a slice to the next
  /// Whether values are stored as CT does (int16, slope 1, intercept -1024, rounded to 1 HU) or as floats.
  bool quantised = true;
  /// In-plane radius of the reconstruction circle about the middle of each slice, mm; beyond it there is padding. 0:
  /// none.
  double circle_radius = 0;
};

/// Throws std::range_error if a value does not fit in the stored type.
io::Volume scan(const Phantom& phantom, const io::Geometry& geometry, const Acquisition& acquisition = {});

}  // namespace palpate::testdata
