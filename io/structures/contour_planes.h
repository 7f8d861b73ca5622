#pragma once

/// Planes of distances from closed contours: for every node the distance to the edge of the filled region
/// (contour_region.h).

#include "io/structures/distance_field.h"
#include "io/structures/outline_planes.h"
#include "io/structures/structure.h"

namespace palpate::io {

/// Points in patient space, mm; the last is joined to the first.
using Contour = std::vector<Vec3>;

/// A file's rules for the contours of one structure.
struct ContourRule {
  bool is_exclusive = false;  ///< CLOSEDPLANAR_XOR: the overlap of two contours is outside
  double thickness_mm = 0;    ///< of a single plane; 0 if unknown
};

/// The contours of one structure, plane by plane.
struct ContourStack {
  glm::dmat3 axes{1};  ///< columns: two along the planes and their normal
  double step_mm = 1;  ///< the typical distance between planes
  struct Plane {
    double height = 0;                              ///< along the normal, mm
    std::vector<std::vector<glm::dvec2>> polygons;  ///< the edges of the inside: they do not cross; even-odd
  };
  std::vector<Plane> planes;   ///< ascending
  std::vector<Text> warnings;  ///< contours that overlap or are repeated, and unevenly spaced planes
};

/// Contours are in one plane if their heights differ by at most 0.01 mm, or by no more than the points of a contour
/// deviate from its plane (up to 0.1 mm). Throws DicomError if the contours are not planar or not parallel, or have no
/// area. A missing plane between two others is not an empty one: the surface goes on through it.
ContourStack stack_of(const std::vector<Contour>& contours, const ContourRule& rule = {});

/// The size of the scan's voxels along the scan's axis that is nearest to the normal of the contours, mm. A single
/// plane has this thickness if nothing else gives one.
double thickness_of_voxels(const Geometry& scan, const Vec3& normal);

/// Whether two neighboring planes at that distance (mm) belong to one body. If not, the bodies end between them.
bool is_one_body(const ContourStack& stack, double apart_mm);

/// Each plane's polygons form a slab that reaches half of the way to its neighbors, or half a step at the ends. Volume
/// and centroid are those of the slabs.
StructureMeasures measures_of(const std::vector<Contour>& contours, const ContourRule& rule = {});

/// The stack must outlive the planes.
OutlinePlanes planes_of(const ContourStack& stack, const DistanceOptions& options);

}  // namespace palpate::io
