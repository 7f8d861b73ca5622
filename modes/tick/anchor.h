#pragma once

/// The anchor: where all co-located primitives of a frame stand, so that a held proxy does not creep through a surface.
///
/// A plane that is placed at the old proxy every frame is the tangent plane there; a tangential step t leaves the
/// iso-surface by t^2 / 2R. On a concave wall that works the proxy into the wall: noise alone sinks it within a minute.
/// So while a surface holds the proxy, the anchor is moved from the old proxy by one Newton step along grad V, back to
/// the value at which it was held; that value is renewed only after the surface has yielded or the proxy has lifted
/// off.
///
/// The value itself has to be taken with care. The sampled V is exact where it is on average, but between voxels its
/// iso-surfaces are rough, by interpolation and by noise, and a hand would feel each voxel: as a wobble of the anchor,
/// and as a strength that flickers. The gradient comes from a filter and is smooth, but its integral along the way
/// drifts. The *level* joins the two: near a surface it follows, from frame to frame, the integral of the gradient
/// (trapezoidal, so that a circle is closed to third order); while held it also returns to V, or to as far from V as it
/// was when the hold began, over some millimeters of travel (defaults::level_length_mm). Away from surfaces it is V. A
/// proxy that does not move keeps its level, and its anchor, to the last bit.

#include <array>
#include <cstdint>

#include "io/fields/field_source.h"
#include "modes/scene/workspace.h"

namespace palpate::modes {

enum class HoldState : std::uint8_t {
  none,     ///< no surface was placed
  lifted,   ///< the proxy has left every surface on the side that it is pushed to
  held,     ///< on a surface
  yielding  ///< pushed through a surface that gives its full strength
};

/// What is remembered of the surface at the proxy.
struct HeldSurface {
  HoldState hold = HoldState::none;
  HoldState before = HoldState::none;  ///< a frame earlier
  double level = 0;                    ///< at the last place sampled, the scan's unit
  double offset = 0;                   ///< of the level from V, where it began to hold
  double held_level = 0;               ///< V_c
  Vec3 place_mm{0};                    ///< last place sampled, patient space
  Vec3 gradient{0};                    ///< there, per mm
};

/// What is remembered of all surfaces: of the scan's own, and of each structure's (Sample::distance).
struct HeldSurfaces {
  HeldSurface scan;
  std::array<HeldSurface, io::most_structures> structure;

  bool is_held() const noexcept;
  /// Forgets the holds, for the proxy has been moved.
  void release() noexcept;
};

/// Brings level, place and gradient up to date with a sample (value and gradient) taken at place_mm. In the tick.
void follow_level(double value, const Vec3& gradient, const Vec3& place_mm, HeldSurface& contact) noexcept;
void follow_level(const io::Sample& sample, const Vec3& place_mm, HeldSurface& contact) noexcept;

/// From the place sampled to the anchor, mm of patient space: zero while nothing holds the proxy, at most
/// defaults::anchor_step_mm long. Renews held_level where nothing holds it. In the tick.
Vec3 anchor_step_mm(HeldSurface& contact) noexcept;

/// The level at the anchor: what strengths there are read from.
double level_at_anchor(const HeldSurface& contact, const Vec3& step_mm) noexcept;

}  // namespace palpate::modes
