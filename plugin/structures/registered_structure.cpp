#include "plugin/structures/registered_structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace palpate::plugin {

std::string in_words(const io::RigidMotion& motion) {
  constexpr double least_degrees = 0.005;
  const double cosine = (motion.turn[0][0] + motion.turn[1][1] + motion.turn[2][2] - 1) / 2;
  const double degrees = glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
  std::string words = fmt::format("{:.1f}, {:.1f}, {:.1f} mm", motion.shift.x, motion.shift.y, motion.shift.z);
  if (degrees > least_degrees) words += fmt::format(", turned by {:.2f} degrees", degrees);
  return words;
}

}  // namespace palpate::plugin
