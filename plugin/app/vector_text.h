#pragma once

/// Points on the command line: "x,y,z" in mm, patient space.

#include <glm/vec3.hpp>
#include <string>

namespace palpate::plugin {

/// Throws WrongUsage naming the option and the text. Independent of the locale.
glm::dvec3 parse_vector(const std::string& text, const std::string& option);

}  // namespace palpate::plugin
