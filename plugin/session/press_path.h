#pragma once

/// Makes a script for the simulated hand from the scan: it comes from outside, presses on the first boundary, slides
/// along it, pushes through to the next ones, and lifts off.

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "io/fields/field_source.h"
#include "modes/scene/plan.h"
#include "plugin/session/path.h"

namespace palpate::plugin {

struct PressPath {
  std::vector<PathPoint> hand;          ///< the hand's targets
  glm::dvec3 inward{0, 0, 1};           ///< unit, patient axes: the direction of pressing
  glm::dvec3 contact_mm{0};             ///< the place of first contact with a boundary
  std::vector<std::size_t> boundaries;  ///< the scene's modes met on the way in, in order
};

/// Feels along the way from `from_mm` to `to_mm` once (a stroke), and writes the script from the boundaries it met.
/// Throws std::runtime_error if nothing is felt on the way.
PressPath make_press_path(const modes::Plan& plan, const io::FieldSource& source, const glm::dvec3& from_mm,
                          const glm::dvec3& to_mm);

}  // namespace palpate::plugin
