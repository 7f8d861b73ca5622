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

/// Triangles must refer only to existing points.
Bytes content_of(const Surface& surface);
/// Reads points and triangles; everything else is ignored. For tests: Palpate accepts no surfaces. Throws InvalidInput
/// if the sizes are inconsistent, before allocating memory.
Surface surface_of(ByteView content);

}  // namespace palpate::plugin::igtl
