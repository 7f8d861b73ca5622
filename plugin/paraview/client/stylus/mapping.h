#pragma once

/// The mapping between hand and scan: a scene's workspace settings, computed from the view. Patient space, mm.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "modes/scene/scene.h"

namespace palpate::plugin {

/// The viewpoint of a 3D view.
struct Eye {
  glm::dvec3 position{0, -1, 0};
  glm::dvec3 focus{0};
  glm::dvec3 up{0, 0, 1};
  double height_mm = 200;  ///< visible height of the patient at the focus
};

/// The device's axes in the patient for a user at this viewpoint: x to the right of the screen, y up, z towards the
/// user.
glm::dmat3 rotation_of(const Eye& eye);

/// Brings the whole scan into reach.
modes::WorkspaceSettings fit_scan(const modes::WorkspaceSettings& now);
/// Brings the visible part of the patient into the device's reach, rotated as in the view: the view's height becomes
/// the device's.
modes::WorkspaceSettings fit_view(const Eye& eye, const glm::dvec3& half_extent_m);
/// 1 mm of the hand is 1 mm in the patient, with the present center.
modes::WorkspaceSettings one_to_one(const modes::Workspace& now);

}  // namespace palpate::plugin
