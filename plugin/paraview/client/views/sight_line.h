#pragma once

/// Whether something in the patient is hidden behind what the volume rendering shows.

#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "io/fields/field_source.h"

namespace palpate::plugin {

/// From a value to the part of the light that a millimeter of it takes: straight between nodes, constant beyond.
struct OpacityNode {
  double value = 0;
  double opacity = 0;  ///< 0 to 1, for each mm
};

/// How much of the light from a place does not reach the eye, 0 to 1: patient space, mm. The last millimeters before
/// the place do not count, because it lies on the surface that it feels.
double hidden_part(const io::FieldSource& source, std::span<const OpacityNode> opacity, const glm::dvec3& eye,
                   const glm::dvec3& place);

/// The place that is seen on the way from one place to another: where half of the light is taken, to half a millimeter.
/// None if less than half is taken. Patient space, mm.
std::optional<glm::dvec3> first_seen(const io::FieldSource& source, std::span<const OpacityNode> opacity,
                                     const glm::dvec3& from, const glm::dvec3& to);

}  // namespace palpate::plugin
