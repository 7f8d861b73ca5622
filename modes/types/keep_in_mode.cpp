// Keep in: see keep.h. Analytical where its structure's are the only planes.
#include "modes/types/keep.h"

namespace palpate::modes {

extern const ModeType keep_in_mode;
const ModeType keep_in_mode{
    .name = "keep_in",
    .summary = "resists and pushes back over a margin before the way out of a structure",
    .keys = Key::strength | Key::gates | Key::margin,
    .strength_of = Datum::value,
    .margin_side = -1,
    .reads = [](const Mode&) { return io::FieldSet::distance; },
    .footprint =
        [](const Mode&) {
          return Footprint{solver::PrimitiveType::plane, Axis::structure, true};
        },
    .place = [](const ActiveMode& mode, const Place& place,
                PrimitiveList& primitives) noexcept { place_keep(mode, place, keep_in_mode.margin_side, primitives); }};

}  // namespace palpate::modes
