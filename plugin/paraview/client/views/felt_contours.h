#pragma once

/// The boundaries of a scene on a slice of the scan, as lines.

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "io/fields/field_source.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/paraview/common/keep_going.h"

namespace palpate::plugin {

/// A plane of points in patient space, mm: row by row from a corner.
struct SlicePoints {
  glm::dvec3 corner{0};
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0};  ///< from point to point
  int columns = 0, rows = 0;
};

/// The line of one of the scene's modes.
struct FeltContour {
  std::size_t mode = 0;
  std::vector<std::array<glm::dvec3, 2>> pieces;  ///< ends, patient space, mm
};

/// The lines of every surface of the plan that has a gate over value. A piece is left out if the surface has no
/// strength there, because the gradient is too small or the tissues differ. If the strength depends on fields that the
/// source does not have, the piece is kept. On any thread; takes about a tenth of a second. Throws io::Cancelled.
std::vector<FeltContour> felt_contours(const modes::Scene& scene, const modes::Plan& plan,
                                       const io::FieldSource& source, const SlicePoints& points,
                                       const KeepGoing& keep_going);

}  // namespace palpate::plugin
