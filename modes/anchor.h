#pragma once

/// The anchor: where all co-located primitives of a frame stand, so that a held proxy does not creep through a surface.
///
/// A plane that is placed at the old proxy every frame is the tangent plane there; a tangential step t leaves the
/// iso-surface by t^2 / 2R. On a concave wall that works the proxy into the wall: noise alone sinks it within a minute.
/// Two things know better where the surface is:
///
/// * the directions at both ends of the step: a chord of a circle is normal to the mean of the normals at its ends, so
/// the
///   anchor that keeps (anchor - last anchor) . (n_last + n) = 0 is off by t^3 only. Smooth, for directions come from a
///   filter; but their errors add up along the way.
/// * the iso-value V_c at which the proxy was first held, by one Newton step along grad V. It never drifts; but noise
/// and the
///   interpolation between voxels make iso-surfaces rough: a hand would feel each voxel.
///
/// So the first leads, and the second corrects it over some millimetres of travel (defaults::anchor_length_mm): a proxy
/// that has not moved is left where it is, to the last bit, and an iso-value that is not found nearby (a boundary that
/// thins out) draws the proxy along a gentle slope and not through the tissue. V_c is renewed only after the surface
/// has yielded or the proxy has lifted off.

#include "palpate/io/field_source.h"
#include "palpate/modes/workspace.h"

namespace palpate::modes {

/// What is remembered of the surface that holds the proxy.
struct Contact {
  bool held = false;
  double value = 0;  ///< V_c
  Vec3 anchor_m{0};  ///< of the last frame, device's frame
  Vec3 uphill{0};    ///< grad V / |grad V| there, device's frame
};

/// The anchor for a proxy at which `sample` (value and gradient) was taken. Where nothing is held yet it is the proxy,
/// and the contact takes the value found there; `contact` is brought up to date but for `held`, which only the solution
/// can tell. At most defaults::anchor_step_mm from the proxy. In the tick.
Vec3 place_anchor(const io::Sample& sample, const Workspace& workspace, const Vec3& proxy_m, Contact& contact) noexcept;

}  // namespace palpate::modes
