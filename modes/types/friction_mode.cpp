// Friction mode, equation (3): a point at the anchor, strength tau(V). A friction of constant threshold: neither
// viscosity nor Coulomb friction, for it does not grow with the pressure; and with surface it also resists lift-off by
// its strength. Analytical with every co-located constraint that is analytical without it.
#include "modes/types/mode_type.h"

namespace palpate::modes {

extern const ModeType friction_mode;
const ModeType friction_mode{.name = "friction",
                             .summary = "resists every movement by a constant force, lift-off too",
                             .keys = Key::strength | Key::gates,
                             .strength_of = Datum::value,
                             .finds_places = false,
                             .reads = [](const Mode&) { return io::FieldSet::none; },
                             .footprint =
                                 [](const Mode&) {
                                   return Footprint{solver::PrimitiveType::point, Axis::none, true};
                                 },
                             .place =
                                 [](const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
                                   primitives.add(solver::make_point(mode.strength(place.sample), place.anchor_m));
                                 }};

}  // namespace palpate::modes
