// Follow mode, equation (9): a line along a vector field U through the anchor, strength tau(|U|): anisotropic friction,
// easy along U. Analytical with force and friction, with surface only where U is the gradient or happens to lie in (or
// across) the plane.
#include "modes/types/direction.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {

extern const ModeType follow_mode;
const ModeType follow_mode{
    .name = "follow",
    .summary = "easy along a vector field, resists across it",
    .keys = Key::strength | Key::gates | Key::direction_of,
    .strength_of = Datum::vector_magnitude,
    .reads = [](const Mode& mode) { return field_of(mode.direction_of); },
    .footprint =
        [](const Mode& mode) {
          return Footprint{solver::PrimitiveType::line, axis_of(mode.direction_of), true};
        },
    .place =
        [](const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
          if (const auto direction = direction_in_device(mode.direction_of, place)) {
            primitives.add(solver::make_line(mode.strength(place.sample), place.anchor_m, *direction));
          }
        }};

}  // namespace palpate::modes
