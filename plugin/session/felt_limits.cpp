#include "plugin/session/felt_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "plugin/messages/messages.h"

namespace palpate::plugin {

namespace ceiling = device::ceiling;

double stiffness_for(const modes::Scene& scene, const device::Specification& stylus) noexcept {
  const double device = stylus.force_axes > 0 ? stylus.stiffness_limit : ceiling::stiffness_n_per_m;
  return std::min({scene.stiffness_n_per_m, device, ceiling::stiffness_n_per_m});
}

modes::Scene suited_to(modes::Scene scene, const device::Specification& stylus) {
  scene.stiffness_n_per_m = stiffness_for(scene, stylus);
  return scene;
}

device::SafetyLimits limits_for(const modes::Limits& scene, const device::Specification& device) noexcept {
  device::SafetyLimits limits;
  limits.device_force = std::min(device.maximum_force, ceiling::force_n);
  limits.force = std::min(scene.force_n, ceiling::force_n);
  limits.slew = std::min(scene.slew_n_per_ms * 1e3, ceiling::slew_n_per_s);
  limits.ramp_time = std::max(scene.ramp_s, ceiling::ramp_s);
  limits.speed = std::min(scene.speed_m_per_s, ceiling::speed_m_per_s);
  return limits;
}

std::vector<Text> drawn_down(const modes::Scene& scene, const device::Specification& stylus) {
  std::vector<Text> said;
  if (stylus.force_axes == 0) return said;
  const device::SafetyLimits limits = limits_for(scene.limits, stylus);
  const double stiffness = stiffness_for(scene, stylus);
  if (stiffness < scene.stiffness_n_per_m) {
    said.push_back(say("stiffness-taken-down", fmt::format("{:.0f}", scene.stiffness_n_per_m),
                       fmt::format("{:.0f}", stiffness), stylus.name));
  }
  const auto compare = [&](const char* key, double asked, double felt, const char* unit) {
    if (asked != felt)
      said.push_back(say("limit-drawn-down", key, fmt::format("{:g}", asked), fmt::format("{:g}", felt), unit));
  };
  compare("force_limit_n", scene.limits.force_n, std::min(limits.force, limits.device_force), "N");
  // Not from `limits`: there and back between units a limit that nothing tightens may differ by rounding.
  compare("slew_limit_n_per_ms", scene.limits.slew_n_per_ms,
          std::min(scene.limits.slew_n_per_ms, ceiling::slew_n_per_s / 1e3), "N/ms");
  compare("ramp_s", scene.limits.ramp_s, limits.ramp_time, "s");
  compare("speed_limit_m_per_s", scene.limits.speed_m_per_s, limits.speed, "m/s");
  return said;
}

}  // namespace palpate::plugin
