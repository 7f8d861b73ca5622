#pragma once

/// The anchor: the place of all co-located primitives of a tick. It keeps a held proxy from creeping through a surface.
///
/// A plane that is placed at the old proxy is the tangent plane there. A tangential step t along it leaves the
/// iso-surface by t^2 / 2R. On a concave wall each step takes the proxy deeper into the wall: noise alone sinks it
/// within a minute. So while a surface holds the proxy, the anchor is moved from the old proxy by one Newton step along
/// grad V, back to the value at which the proxy was held. That value is renewed only after the surface has yielded or
/// the proxy has lifted off.
///
/// The sampled V cannot be that value. It is right on average, but between voxels its iso-surfaces are rough through
/// interpolation and noise; a hand would feel each voxel as a wobble of the anchor and a flicker of the strength. The
/// gradient comes from a filter and is smooth, but its integral along the way drifts. The *level* combines the two.
/// Along a surface it follows the integral of the gradient from tick to tick (by the trapezoidal rule, so that a closed
/// circle leaves an error of third order only). Across it, where a proxy that is not held is pushed through, it follows
/// V: in a plate thinner than the filter, the filtered gradient is smaller than the slope, and its integral would never
/// reach the plate's values. While the proxy is held, the level also returns to V plus the offset from V that it had
/// when the hold began, over some millimeters of travel (defaults::level_length_mm). Away from surfaces it is V. A
/// proxy that does not move keeps its level, and its anchor, to the last bit.

#include <algorithm>
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

/// The common state of two surfaces: held by one takes precedence over yielding through the other.
constexpr HoldState joined(HoldState one, HoldState other) noexcept {
  if (one == HoldState::held || other == HoldState::held) return HoldState::held;
  return std::max(one, other);
}

/// The state of the surface at the proxy.
struct HeldSurface {
  HoldState hold = HoldState::none;
  HoldState before = HoldState::none;  ///< in the previous tick
  double level = 0;                    ///< at the last place sampled, the scan's unit
  double offset = 0;                   ///< of the level from V, at the start of the hold
  double held_level = 0;               ///< the level at which the proxy is held
  double value = 0;                    ///< V at the last place sampled, the scan's unit
  Vec3 place_mm{0};                    ///< last place sampled, patient space
  Vec3 gradient{0};                    ///< there, per mm
};

/// The state of all surfaces: of the scan's own, and of each structure's (Sample::distance).
struct HeldSurfaces {
  HeldSurface scan;
  std::array<HeldSurface, io::most_structures> structure;

  bool is_held() const noexcept;
  /// Forgets every hold. Call it when something else has moved the proxy.
  void release() noexcept;
};

/// Brings level, place and gradient up to date with a sample (value and gradient) taken at place_mm. In the tick.
void follow_level(double value, const Vec3& gradient, const Vec3& place_mm, HeldSurface& contact) noexcept;
void follow_level(const io::Sample& sample, const Vec3& place_mm, HeldSurface& contact) noexcept;

/// The step from the place sampled to the anchor, mm of patient space. Zero if nothing holds the proxy; held_level is
/// then renewed. At most defaults::anchor_step_mm long. In the tick.
Vec3 anchor_step_mm(HeldSurface& contact) noexcept;

/// The level at the anchor: strengths are looked up at this value there.
double level_at_anchor(const HeldSurface& contact, const Vec3& step_mm) noexcept;

}  // namespace palpate::modes
