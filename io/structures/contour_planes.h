#pragma once

/// Closed contours as planes of distances: of every node the distance to the polygons themselves, holes by even-odd.

#include "io/structures/distance_field.h"
#include "io/structures/outline_planes.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// Points in patient space, mm; the last is joined to the first.
using Contour = std::vector<Vec3>;

/// The contours of one structure, plane by plane.
struct ContourStack {
  glm::dmat3 axes{1};  ///< columns: two along the planes and their normal
  double step_mm = 1;  ///< between planes
  struct Plane {
    double height = 0;  ///< along the normal, mm
    std::vector<std::vector<glm::dvec2>> polygons;
  };
  std::vector<Plane> planes;  ///< ascending
  std::size_t contours = 0;
};

/// Throws DicomError where the contours are not planar or not parallel. A plane that is missing between two others is
/// not taken for an empty one: the surface goes on through it.
ContourStack stack_of(const std::vector<Contour>& contours);

/// The volume is that of the polygons, each as thick as the planes are apart; the centroid that of this volume.
StructureMeasures measures_of(const std::vector<Contour>& contours);

/// The stack has to live as long as the planes.
OutlinePlanes planes_of(const ContourStack& stack, const DistanceOptions& options);

}  // namespace palpate::io
