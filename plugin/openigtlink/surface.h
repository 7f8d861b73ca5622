#pragma once

/// POLYDATA: a surface of triangles with normals, RAS, mm. Source: OpenIGTLink protocol, "POLYDATA".

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "plugin/openigtlink/bytes.h"

namespace palpate::plugin::igtl {

struct Surface {
  std::vector<glm::dvec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counterclockwise, seen from outside
};

/// No triangle may name a point that is not there.
Bytes content_of(const Surface& surface);
/// Reads the points and the polygons of three corners; all else is passed over. For tests: Palpate takes no surfaces.
/// Throws InvalidInput if the sizes do not fit together, before memory is taken for them.
Surface surface_of(ByteView content);

}  // namespace palpate::plugin::igtl
