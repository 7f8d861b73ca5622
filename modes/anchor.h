#pragma once

/// The anchor: where all co-located primitives of a frame stand, so that a held proxy does not creep through a surface.
///
/// A plane that is placed at the old proxy every frame is the tangent plane there; a tangential step t leaves the
/// iso-surface by t^2 / 2R. On a concave wall that works the proxy into the wall: noise alone sinks it within a minute.
/// So while a surface holds the proxy, the iso-value V_c of the contact is remembered, and every frame the anchor is
/// moved from the old proxy by one Newton step along grad V back to V = V_c. V_c is renewed only after the surface has
/// yielded or the proxy has lifted off.

#include "palpate/io/field_source.h"
#include "palpate/modes/workspace.h"

namespace palpate::modes {

/// The Newton step from the old proxy towards V = held_value, mm of patient space, at most `most_mm` long. Zero where
/// the gradient is. In the tick.
Vec3 anchor_correction_mm(const io::Sample& sample, double held_value, double most_mm) noexcept;

/// The longest correction, mm, after the proxy has moved by `travel_mm` since it was last anchored:
/// defaults::anchor_step_mm, and never more than a fixed part of the travel. What creeps by t^2 / 2R needs t / 2R of
/// its travel, little; a proxy that has not moved needs none and is left as it is, to the last bit; and an iso-value
/// that is no longer found nearby (a boundary that thins out) draws the proxy along a slope, not through the tissue.
double most_correction_mm(double travel_mm) noexcept;

}  // namespace palpate::modes
