#pragma once

/// The parts that every JSON text with marks has.

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "plugin/recording/marks.h"

namespace palpate::plugin {

/// [x, y, z].
nlohmann::ordered_json json_of(const glm::dvec3& v);
/// An object: name, tick, time_s, position_mm, boundary, value (null outside the scan), force_n.
nlohmann::ordered_json json_of(const FeltMark& mark);

}  // namespace palpate::plugin
