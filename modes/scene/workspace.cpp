#include "modes/scene/workspace.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace palpate::modes {

Workspace between(const Workspace& from, const Workspace& to, double part) noexcept {
  if (part <= 0 || from == to) {
    return from;
  }
  if (part >= 1) {
    return to;
  }
  Workspace workspace;
  workspace.center_mm = from.center_mm + part * (to.center_mm - from.center_mm);
  workspace.rotation = glm::mat3_cast(glm::slerp(glm::quat_cast(from.rotation), glm::quat_cast(to.rotation), part));
  workspace.mm_per_m = from.mm_per_m * std::pow(to.mm_per_m / from.mm_per_m, part);
  return workspace;
}

}  // namespace palpate::modes
