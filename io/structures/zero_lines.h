#pragma once

/// Lines along which values on a plane's lattice cross zero.

#include <glm/vec2.hpp>
#include <span>

#include "io/structures/contour_region.h"

namespace palpate::io {

/// Closed lines, in nodes, between the values above 0 and the others: linear along the lattice's edges. Values above 0
/// are to the left of a line (if j points up), so outer lines run counterclockwise and lines around holes clockwise.
/// They do not cross. `values`: nodes.x * nodes.y of them, i fastest; those at the border must not be above 0.
std::vector<ContourPolygon> zero_lines(std::span<const double> values, const glm::ivec2& nodes);

/// The lines with fewer points. Kept points are not moved, and the points that are left out lie within 0.01 mm of the
/// new lines. A line narrower than that is left out.
std::vector<ContourPolygon> thinned(const std::vector<ContourPolygon>& lines_mm);

}  // namespace palpate::io
