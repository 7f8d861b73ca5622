#pragma once

/// Where a stylus begins that can be put anywhere: outside of the patient and of anything felt, in sight, in reach.

#include <functional>
#include <glm/vec3.hpp>
#include <memory>

#include "io/volume.h"
#include "modes/scene/plan.h"

namespace palpate::plugin {

struct StartPlace {
  glm::dvec3 place_mm{0};  ///< patient space
  bool outside = false;    ///< in front of or beside the patient, with nothing felt there
  bool seen = false;       ///< in every view
};

/// The best of an even grid over the scan: nearest to a finger's breadth in front of what is met first on the way from
/// the front to the middle. What is outside hangs together with the scan's front, back, left or right, and is thinner
/// than tissue (-300 HU; elsewhere 15 % of the way from the lowest value to the highest). Where no place in reach is
/// outside, the best of the others is given, and `outside` is false.
StartPlace find_start_place(const std::shared_ptr<const io::Volume>& volume, const modes::Plan& plan,
                            double gradient_scale_mm, const std::function<bool(const glm::dvec3&)>& in_reach,
                            const std::function<bool(const glm::dvec3&)>& in_sight);

}  // namespace palpate::plugin
