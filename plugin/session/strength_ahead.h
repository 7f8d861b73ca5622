#pragma once

/// The strength of a surface ahead of the proxy, before it lets the proxy through.

#include <glm/vec3.hpp>

#include "io/fields/field_source.h"
#include "modes/scene/plan.h"

namespace palpate::plugin {

/// N: how much of a push along `inward` (unit, patient space) the mode, a surface, resists at a sample; 0 if it pushes
/// that way itself, as on the far side of a plate.
double strength_against_n(const modes::ActiveMode& mode, const io::Sample& sample, const glm::dvec3& inward);

/// N: the largest force that the mode, a surface, resists on the next 3 mm from a place (patient space, mm) along
/// `inward` (unit). Places behind a break-through are not counted. These are places that a slowly pushed probe reaches
/// only after the proxy has jumped and half of the force was lost. 31 samples: not for the tick.
double strength_ahead_n(const modes::ActiveMode& mode, const modes::Plan& plan, const io::FieldSource& source,
                        const glm::dvec3& place_mm, const glm::dvec3& inward);

}  // namespace palpate::plugin
