#pragma once

/// Whether the volume rendering hides a place in the patient.

#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "io/fields/field_source.h"

namespace palpate::plugin {

/// The fraction of light that a millimeter of a value absorbs: linear between nodes, constant beyond.
struct OpacityNode {
  double value = 0;
  double opacity = 0;  ///< 0 to 1, for each mm
};

/// The fraction of light from a place that does not reach the eye, 0 to 1: patient space, mm. The last millimeters
/// before the place do not count, because the place is on the felt surface.
double hidden_part(const io::FieldSource& source, std::span<const OpacityNode> opacity, const glm::dvec3& eye,
                   const glm::dvec3& place);

/// The visible place on the way from one place to another: where half of the light is absorbed, to half a millimeter.
/// None if less than half is absorbed. Patient space, mm.
std::optional<glm::dvec3> first_seen(const io::FieldSource& source, std::span<const OpacityNode> opacity,
                                     const glm::dvec3& from, const glm::dvec3& to);

}  // namespace palpate::plugin
