#pragma once

/// The surface of a structure, as triangles, from its distance. Source: "naive surface nets", after S. F. F. Gibson,
/// "Constrained elastic surface nets", MICCAI 1998; here each vertex is moved on to the surface by the distance itself.

#include <functional>

#include "io/bounding_box.h"
#include "plugin/openigtlink/surface.h"

namespace palpate::plugin::igtl {

/// Signed distance, mm, positive inside, and its gradient.
struct SurfaceDistance {
  double mm = 0;
  glm::dvec3 gradient{0};
};

/// In the frame of the box, with cells of 1 mm, or of 2, 4 ... mm if there would be more than 60 000 of them. Cells
/// whose middle is farther from the surface than their corners are not looked at.
Surface isosurface(const std::function<SurfaceDistance(const glm::dvec3&)>& distance, const io::Box& box);

}  // namespace palpate::plugin::igtl
