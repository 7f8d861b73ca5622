#pragma once

/// Turns closed contours into planes of distances: for every node the distance to the edge of the region that the
/// contours fill (contour_region.h).

#include "io/structures/distance_field.h"
#include "io/structures/outline_planes.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// Points in patient space, mm; the last is joined to the first.
using Contour = std::vector<Vec3>;

/// How a file describes the contours of one structure.
struct ContourRule {
  bool is_exclusive = false;  ///< CLOSEDPLANAR_XOR: a region inside two contours is outside
  double thickness_mm = 0;    ///< of a plane alone; 0 if nobody says it
};

/// The contours of one structure, plane by plane.
struct ContourStack {
  glm::dmat3 axes{1};  ///< columns: two along the planes and their normal
  double step_mm = 1;  ///< typical distance between planes
  struct Plane {
    double height = 0;                              ///< along the normal, mm
    std::vector<std::vector<glm::dvec2>> polygons;  ///< the edges of the inside; they do not cross; even-odd
  };
  std::vector<Plane> planes;   ///< ascending
  std::vector<Text> warnings;  ///< overlapping or repeated contours, and planes at uneven distances
};

/// Contours lie in one plane if their heights differ by at most 0.01 mm, or by at most the deviation of contour points
/// from their plane (up to 0.1 mm). Throws DicomError if the contours are not planar or not parallel, or have no area.
/// A plane that is missing between two others is not taken for an empty one: the surface goes on through it.
ContourStack stack_of(const std::vector<Contour>& contours, const ContourRule& rule = {});

/// Whether the surface continues between two neighboring planes at this distance (mm). If not, both parts end between
/// them.
bool is_one_body(const ContourStack& stack, double apart_mm);

/// Each plane's polygons are slabs that extend half the way to the neighboring planes, or half a step if there is none.
/// Volume and centroid are those of the slabs.
StructureMeasures measures_of(const std::vector<Contour>& contours, const ContourRule& rule = {});

/// The stack must outlive the planes.
OutlinePlanes planes_of(const ContourStack& stack, const DistanceOptions& options);

}  // namespace palpate::io
