#pragma once

#include <vector>

#include "io/structures/contour_region.h"

namespace palpate::io {

/// One contour for each line around an inside: its holes are joined to it by a way there and back along the shortest
/// connection of two points. `lines`: counterclockwise around what is inside, clockwise around holes; they do not
/// cross.
std::vector<ContourPolygon> with_keyholes(const std::vector<ContourPolygon>& lines);

}  // namespace palpate::io
