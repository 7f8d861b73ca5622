#pragma once

#include <vector>

#include "io/structures/contour_region.h"

namespace palpate::io {

/// One contour for each outer line. Its holes are joined to it by a line there and back along the shortest connection
/// of two points. `lines`: counterclockwise around what is inside, clockwise around holes; they do not cross.
std::vector<ContourPolygon> with_keyholes(const std::vector<ContourPolygon>& lines);

}  // namespace palpate::io
