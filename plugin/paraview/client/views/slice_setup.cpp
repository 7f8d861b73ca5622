#include "plugin/paraview/client/views/slice_setup.h"

#include <vtkStructuredData.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::plugin {
namespace {

constexpr int scanners_axis = 2;

/// Half the size of the scan as it is seen along `direction`.
double half_extent(const ImageLattice& lattice, const glm::dvec3& direction) {
  double half = 0;
  for (int axis = 0; axis < 3; ++axis) {
    half += 0.5 * (lattice.dimensions[axis] - 1) * lattice.spacing[axis] *
            std::abs(glm::dot(lattice.directions[static_cast<std::size_t>(axis)], direction));
  }
  return half;
}

/// As the scanner counts its own slices; those across them, the way the wheel goes.
SliceNumbers numbers_of(const ImageLattice& lattice, Plane plane, const Sight& sight) {
  if (sight.index_axis == scanners_axis) return {.from_last = lattice.counted_from_last};
  return {.from_last = glm::dot(lattice.directions[static_cast<std::size_t>(sight.index_axis)], upwards(plane)) < 0};
}

}  // namespace

int slice_mode(const Sight& sight) {
  return sight.index_axis == 2 ? VTK_XY_PLANE : sight.index_axis == 1 ? VTK_XZ_PLANE : VTK_YZ_PLANE;
}

SliceSetup setup_of(const ImageLattice& lattice, Plane plane) {
  const Sight sight = sight_of(plane, lattice.directions);
  const int across = sight.index_axis;
  const glm::dvec3& to_next = lattice.directions[static_cast<std::size_t>(across)];
  return {.plane = plane,
          .sight = sight,
          .slices = lattice.dimensions[across],
          .numbers = numbers_of(lattice, plane, sight),
          .as_scanned = across == scanners_axis,
          .pixel_mm = std::min(lattice.spacing[(across + 1) % 3], lattice.spacing[(across + 2) % 3]),
          .first_mm = glm::dot(lattice.origin, sight.along),
          .pitch_mm = lattice.spacing[across] * glm::dot(to_next, sight.along),
          .center_mm = lattice.center(),
          .half_height_mm = half_extent(lattice, sight.up),
          .half_width_mm = half_extent(lattice, glm::cross(sight.along, sight.up))};
}

}  // namespace palpate::plugin
