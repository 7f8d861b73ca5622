// Force mode, equation (8): a directed force along a vector field U, strength tau(|U|). It adds energy: no passivity
// bound holds for a scene with it. Analytical with everything.
#include "modes/types/direction.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {

extern const ModeType force_mode;
const ModeType force_mode{
    .name = "force",
    .summary = "pushes along a vector field (or the gradient)",
    .keys = Key::strength | Key::gates | Key::direction_of,
    .strength_of = Datum::vector_magnitude,
    .reads = [](const Mode& mode) { return field_of(mode.direction_of); },
    .footprint =
        [](const Mode& mode) {
          return Footprint{solver::PrimitiveType::directed_force, axis_of(mode.direction_of), true};
        },
    .place =
        [](const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
          if (const auto direction = direction_in_device(mode.direction_of, place)) {
            primitives.add(solver::make_directed_force(mode.strength(place.sample), *direction));
          }
        }};

}  // namespace palpate::modes
