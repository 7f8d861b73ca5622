#pragma once

/// Directions of sampled fields, for the modes.

#include <glm/geometric.hpp>
#include <optional>

#include "modes/types/mode_type.h"

namespace palpate::modes {

inline io::FieldSet field_of(DirectionField field) {
  return field == DirectionField::gradient ? io::FieldSet::gradient : io::FieldSet::vector;
}
inline Axis axis_of(DirectionField field) {
  return field == DirectionField::gradient ? Axis::gradient : Axis::vector;
}

/// A vector of patient space as a unit vector in the device's frame; nothing if it is zero or too small to have a
/// direction. So a homogeneous region has no primitive instead of one with zero direction. In the tick.
inline std::optional<Vec3> unit_in_device(const Vec3& patient, const Workspace& workspace) noexcept {
  const double length = glm::length(patient);
  if (!(length > 1e-150)) {
    return std::nullopt;
  }
  return workspace.direction_to_device(patient / length);
}

inline std::optional<Vec3> direction_in_device(DirectionField field, const Place& place) noexcept {
  return unit_in_device(field == DirectionField::gradient ? place.sample.gradient : place.sample.vector,
                        place.workspace);
}

}  // namespace palpate::modes
