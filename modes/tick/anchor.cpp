#include "modes/tick/anchor.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "modes/scene/defaults.h"

namespace palpate::modes {
namespace {

// Below this a gradient has no direction that a step could take.
constexpr double least_slope = 1e-150;

// The part of a movement that is across the surface: the squared cosine between its direction and the normal, 0 to 1.
double share_across(double rise, const Vec3& slope, const Vec3& moved) {
  const double most = glm::dot(slope, slope) * glm::dot(moved, moved);
  return most > 0 ? std::min(rise * rise / most, 1.0) : 0.0;
}

}  // namespace

bool HeldSurfaces::is_held() const noexcept {
  bool held = scan.hold == HoldState::held;
  for (const HeldSurface& surface : structure) held = held || surface.hold == HoldState::held;
  return held;
}

void HeldSurfaces::release() noexcept {
  scan.hold = HoldState::none;
  for (HeldSurface& surface : structure) surface.hold = HoldState::none;
}

void follow_level(const io::Sample& sample, const Vec3& place_mm, HeldSurface& contact) noexcept {
  follow_level(sample.value, sample.gradient, place_mm, contact);
}

void follow_level(double value, const Vec3& gradient, const Vec3& place_mm, HeldSurface& contact) noexcept {
  if (contact.hold == HoldState::none) {
    contact.level = value;
  } else {
    const Vec3 moved = place_mm - contact.place_mm;
    const Vec3 slope = 0.5 * (contact.gradient + gradient);
    const double rise = glm::dot(slope, moved);
    // A proxy that is held moves with the surface: there the value changes only by interpolation and noise. The
    // smoothed slope gives the length of the anchor's step.
    const double across = contact.hold == HoldState::held ? 0.0 : share_across(rise, slope, moved);
    contact.level += across * (value - contact.value) + (1 - across) * rise;
    if (contact.hold != HoldState::held) {
      contact.offset = 0;
    } else if (contact.before != HoldState::held) {
      contact.offset = contact.level - value;
    }
    // Not while yielding: then the strength is felt, and a steep strength curve would make each step of the level felt.
    if (contact.hold != HoldState::yielding) {
      // A value that is not found nearby (a boundary that thins out) draws the proxy along a gentle slope, not through
      // it.
      const double reach = defaults::level_reach_mm * glm::length(gradient);
      const double weight = -std::expm1(-glm::length(moved) / defaults::level_length_mm);
      contact.level += weight * std::clamp(value + contact.offset - contact.level, -reach, reach);
    }
  }
  contact.before = contact.hold;
  contact.value = value;
  contact.place_mm = place_mm;
  contact.gradient = gradient;
}

Vec3 anchor_step_mm(HeldSurface& contact) noexcept {
  if (contact.hold != HoldState::held) {
    contact.held_level = contact.level;
    return Vec3(0);
  }
  const double slope = glm::length(contact.gradient);
  if (!(slope > least_slope)) {
    return Vec3(0);
  }
  const double step =
      std::clamp((contact.held_level - contact.level) / slope, -defaults::anchor_step_mm, defaults::anchor_step_mm);
  return (step / slope) * contact.gradient;
}

double level_at_anchor(const HeldSurface& contact, const Vec3& step_mm) noexcept {
  return contact.level + glm::dot(contact.gradient, step_mm);
}

}  // namespace palpate::modes
