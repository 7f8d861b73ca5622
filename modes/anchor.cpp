#include "palpate/modes/anchor.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "palpate/modes/defaults.h"

namespace palpate::modes {
namespace {

/// Signed step along uphill from the proxy to the anchor, mm.
double correction_mm(const io::Sample& sample, double slope, const Vec3& uphill, const Vec3& moved_mm,
                     double held_value) {
  const double by_direction = -0.5 * glm::dot(moved_mm, uphill);
  const double by_value =
      std::clamp((held_value - sample.value) / slope, -defaults::anchor_reach_mm, defaults::anchor_reach_mm);
  const double weight = -std::expm1(-glm::length(moved_mm) / defaults::anchor_length_mm);
  const double step = by_direction + weight * (by_value - by_direction);
  return std::clamp(step, -defaults::anchor_step_mm, defaults::anchor_step_mm);
}

}  // namespace

Vec3 place_anchor(const io::Sample& sample, const Workspace& workspace, const Vec3& proxy_m,
                  Contact& contact) noexcept {
  const double slope = glm::length(sample.gradient);
  if (!(slope > 1e-150)) {
    contact = Contact{};
    return proxy_m;
  }
  const Vec3 uphill = workspace.direction_to_device(sample.gradient / slope);
  Vec3 anchor = proxy_m;
  if (contact.held) {
    const Vec3 moved_mm = (proxy_m - contact.anchor_m) * workspace.mm_per_m;
    anchor += uphill * (correction_mm(sample, slope, uphill, moved_mm, contact.value) / workspace.mm_per_m);
  } else {
    contact.value = sample.value;
  }
  contact.anchor_m = anchor;
  contact.uphill = uphill;
  return anchor;
}

}  // namespace palpate::modes
