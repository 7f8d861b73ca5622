// Surface mode, equation (10): a plane through the anchor, normal to the gradient of the value, strength tau(...).
// Entering: it pushes towards lower values (q = -grad V), so that going to higher ones is resisted; leaving: q = +grad
// V, as printed in (10); both: two opposed planes. Analytical with force, friction and other surfaces.
#include "modes/types/direction.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {

extern const ModeType surface_mode;
const ModeType surface_mode{.name = "surface",
                            .summary = "resists crossing a boundary between tissues",
                            .keys = Key::strength | Key::gates | Key::side | Key::tissues,
                            .strength_of = Datum::gradient_magnitude,
                            .reads = [](const Mode&) { return io::FieldSet::gradient | io::FieldSet::value; },
                            .footprint =
                                [](const Mode&) {
                                  return Footprint{solver::PrimitiveType::plane, Axis::gradient, true};
                                },
                            .place =
                                [](const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
                                  const auto uphill = direction_in_device(DirectionField::gradient, place);
                                  if (!uphill) {
                                    return;
                                  }
                                  const double strength = mode.strength(place.sample);
                                  if (mode.side != Side::leaving) {
                                    primitives.add(solver::make_plane(strength, place.anchor_m, -*uphill));
                                  }
                                  if (mode.side != Side::entering) {
                                    primitives.add(solver::make_plane(strength, place.anchor_m, *uphill));
                                  }
                                }};

}  // namespace palpate::modes
