#pragma once

/// The region filled by the contours of one plane.

#include <glm/vec2.hpp>
#include <vector>

namespace palpate::io {

/// mm; the last point is joined to the first.
using ContourPolygon = std::vector<glm::dvec2>;

struct ContourRegion {
  /// They do not cross; those around the region run counterclockwise, those around holes clockwise.
  std::vector<ContourPolygon> edges;
  int doubled = 0;          ///< contours left out because another one is the same
  bool is_overlap = false;  ///< whether contours overlap partly
};

/// A contour that crosses itself, or leads to a hole and back along the same way ("keyhole"), fills by even-odd. A
/// contour inside another cuts a hole, a third inside that one is an island, and so on. Others are joined; cracks of up
/// to 0.01 mm between them are closed. A repeated contour counts once. Windings and order do not matter. If
/// `is_exclusive`, all contours fill by even-odd. Throws DicomError if they span more than can be felt.
ContourRegion region_of(const std::vector<ContourPolygon>& contours, bool is_exclusive);

/// mm^2; holes are subtracted. `moment`: the centroid times the area.
double area_of(const std::vector<ContourPolygon>& edges, glm::dvec2& moment);

}  // namespace palpate::io
