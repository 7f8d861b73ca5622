#pragma once

/// How hand and scan are mapped: workspace settings of a scene, from what is on the screen. Patient space, mm.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "modes/scene/scene.h"

namespace palpate::plugin {

/// What a 3D view looks at.
struct Eye {
  glm::dvec3 position{0, -1, 0};
  glm::dvec3 focus{0};
  glm::dvec3 up{0, 0, 1};
  double height_mm = 200;  ///< of the patient, from the view's lower edge to its upper one at the focus
};

/// The device's axes in the patient for a user who looks through that eye: x to the right of the screen, y up, z
/// towards the user.
glm::dmat3 rotation_of(const Eye& eye);

/// The whole scan in reach.
modes::WorkspaceSettings fit_scan(const modes::WorkspaceSettings& now);
/// Puts what the view shows into the device's reach, turned as the view is: the view's height becomes the device's.
modes::WorkspaceSettings fit_view(const Eye& eye, const glm::dvec3& half_extent_m);
/// 1 mm of the hand is 1 mm in the patient, around the point that is in the middle now.
modes::WorkspaceSettings one_to_one(const modes::Workspace& now);

}  // namespace palpate::plugin
