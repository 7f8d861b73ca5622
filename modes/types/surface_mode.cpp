// Surface mode, equation (10): a plane through the anchor, normal to the gradient of the value, strength tau(...).
// Entering: it pushes towards lower values (q = -grad V), so that going to higher ones is resisted; leaving: q = +grad
// V, as printed in (10); both: two opposed planes. Analytical with force, friction and other surfaces.
//
// At a structure's edge the value is the distance from it: entering resists going in, leaving going out. Its strength
// is there within a wall that begins at the edge and is as thick as a hand can tell.
#include <algorithm>

#include "modes/types/direction.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {
namespace {

constexpr double wall_mm = 1.0;
constexpr double flank_mm = 0.2;  // over which its strength rises and falls, half of it on each side

double rise(double way_mm) noexcept {
  const double t = std::clamp(way_mm / flank_mm + 0.5, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// 1 within the wall; `way` is how far beyond the edge, in the direction that is resisted, mm.
double wall(double way_mm) noexcept {
  return rise(way_mm) * (1.0 - rise(way_mm - wall_mm));
}

void place_planes(Side side, double entering_n, double leaving_n, const Vec3& anchor_m, const Vec3& uphill,
                  PrimitiveList& primitives) noexcept {
  if (side != Side::leaving) {
    primitives.add(solver::make_plane(entering_n, anchor_m, -uphill));
  }
  if (side != Side::entering) {
    primitives.add(solver::make_plane(leaving_n, anchor_m, uphill));
  }
}

void place_at_structure(const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
  const auto n = static_cast<std::size_t>(mode.structure);
  const io::Distance distance = place.sample.distance[n];
  const double way = distance.mm - mode.level_mm;
  const double entering = wall(way);
  const double leaving = wall(-way);
  if (!(entering > 0) && !(leaving > 0)) {
    return;
  }
  if (const auto inward = unit_in_device(distance.gradient, place.workspace)) {
    const double strength = mode.strength(place.sample);
    place_planes(mode.side, entering * strength, leaving * strength, place.structure_anchor_m[n], *inward, primitives);
  }
}

void place_surface(const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
  if (mode.structure >= 0) {
    place_at_structure(mode, place, primitives);
  } else if (const auto uphill = direction_in_device(DirectionField::gradient, place)) {
    const double strength = mode.strength(place.sample);
    place_planes(mode.side, strength, strength, place.anchor_m, *uphill, primitives);
  }
}

}  // namespace

extern const ModeType surface_mode;
const ModeType surface_mode{.name = "surface",
                            .summary = "resists crossing a boundary between tissues, or the edge of a structure",
                            .keys = Key::strength | Key::gates | Key::side | Key::tissues | Key::structure,
                            .strength_of = Datum::gradient_magnitude,
                            .reads =
                                [](const Mode& mode) {
                                  return mode.structure.empty() ? io::FieldSet::gradient | io::FieldSet::value
                                                                : io::FieldSet::distance;
                                },
                            .footprint =
                                [](const Mode& mode) {
                                  return Footprint{solver::PrimitiveType::plane,
                                                   mode.structure.empty() ? Axis::gradient : Axis::structure, true};
                                },
                            .place = place_surface};

}  // namespace palpate::modes
