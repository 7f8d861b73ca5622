#pragma once

/// The starting place of a stylus that can be put anywhere: outside the patient and anything felt, visible, and within
/// reach.

#include <functional>
#include <glm/vec3.hpp>
#include <memory>

#include "io/volume.h"
#include "modes/scene/plan.h"

namespace palpate::plugin {

struct StartPlace {
  glm::dvec3 place_mm{0};  ///< patient space
  bool outside = false;    ///< in front of or beside the patient, where nothing is felt
  bool seen = false;       ///< visible in every view
};

/// The best place of an even grid over the scan: nearest to a finger's breadth in front of the first surface on the way
/// from the front to the middle. Outside means connected with the scan's front, back, left or right, and below tissue
/// (-300 HU; without HU 15 % of the way from the lowest value to the highest). If no place within reach is outside, the
/// best of the others is returned, and `outside` is false.
StartPlace find_start_place(const std::shared_ptr<const io::Volume>& volume, const modes::Plan& plan,
                            double gradient_scale_mm, const std::function<bool(const glm::dvec3&)>& in_reach,
                            const std::function<bool(const glm::dvec3&)>& in_sight);

}  // namespace palpate::plugin
