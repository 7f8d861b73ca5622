// Tube mode, equation (4): a line along the eigenvector of least curvature of the value's Hessian, strength tau(V):
// follow a vessel or a nerve in a scalar scan. The line passes through the old proxy, not through the vessel's middle:
// it guides, it does not center. Analytical with force and friction; with surface only where the vessel happens to lie
// in the plane.
#include "modes/types/direction.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {

extern const ModeType tube_mode;
const ModeType tube_mode{
    .name = "tube",
    .summary = "easy along a vessel, resists across it",
    .keys = Key::strength | Key::gates,
    .strength_of = Datum::value,
    .reads = [](const Mode&) { return io::FieldSet::tube; },
    .footprint =
        [](const Mode&) {
          return Footprint{solver::PrimitiveType::line, Axis::tube, true};
        },
    .place =
        [](const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
          if (const auto direction = unit_in_device(place.sample.tube, place.workspace)) {
            primitives.add(solver::make_line(mode.strength(place.sample), place.anchor_m, *direction));
          }
        }};

}  // namespace palpate::modes
