#pragma once

/// Closed contours as planes of distances: of every node the distance to the edge of what they fill (contour_region.h).

#include "io/structures/distance_field.h"
#include "io/structures/outline_planes.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// Points in patient space, mm; the last is joined to the first.
using Contour = std::vector<Vec3>;

/// What a file says of the contours of one structure.
struct ContourRule {
  bool is_exclusive = false;  ///< CLOSEDPLANAR_XOR: what two contours hold is outside
  double thickness_mm = 0;    ///< of a plane alone; 0 if nobody says it
};

/// The contours of one structure, plane by plane.
struct ContourStack {
  glm::dmat3 axes{1};  ///< columns: two along the planes and their normal
  double step_mm = 1;  ///< between planes: what is typical
  struct Plane {
    double height = 0;                              ///< along the normal, mm
    std::vector<std::vector<glm::dvec2>> polygons;  ///< the edges of what is inside: they do not cross; even-odd
  };
  std::vector<Plane> planes;   ///< ascending
  std::vector<Text> warnings;  ///< contours that overlap or are there twice, and planes that lie unevenly
};

/// Contours whose heights differ by 0.01 mm at most lie in one plane, or by as much as points of a contour differ from
/// its plane (up to 0.1 mm). Throws DicomError if the contours are not planar or not parallel, or have no area. A
/// plane that is missing between two others is not taken for an empty one: the surface goes on through it.
ContourStack stack_of(const std::vector<Contour>& contours, const ContourRule& rule = {});

/// Whether two neighboring planes that far apart (mm) hold one body. If not, both end between them.
bool is_one_body(const ContourStack& stack, double apart_mm);

/// Each plane's polygons reach half of the way to its neighbors, and half a step where there is none. The volume is
/// that of these slabs; the centroid that of this volume.
StructureMeasures measures_of(const std::vector<Contour>& contours, const ContourRule& rule = {});

/// The stack has to live as long as the planes.
OutlinePlanes planes_of(const ContourStack& stack, const DistanceOptions& options);

}  // namespace palpate::io
