#include "palpate/modes/anchor.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "palpate/modes/defaults.h"

namespace palpate::modes {

Vec3 anchor_correction_mm(const io::Sample& sample, double held_value, double most_mm) noexcept {
  const double length = glm::length(sample.gradient);
  if (!(length > 1e-150)) {
    return Vec3(0);
  }
  const double step = std::clamp((held_value - sample.value) / length, -most_mm, most_mm);
  return (step / length) * sample.gradient;
}

double most_correction_mm(double travel_mm) noexcept {
  return std::min(defaults::anchor_step_mm, defaults::anchor_slope * travel_mm);
}

}  // namespace palpate::modes
