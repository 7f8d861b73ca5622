// Keep out: see keep.h. Analytical where its structure's are the only planes.
#include "modes/types/keep.h"

namespace palpate::modes {

extern const ModeType keep_out_mode;
const ModeType keep_out_mode{.name = "keep_out",
                             .summary = "resists and pushes back over a margin before a structure",
                             .keys = Key::strength | Key::gates | Key::margin,
                             .strength_of = Datum::value,
                             .reads = [](const Mode&) { return io::FieldSet::distance; },
                             .footprint =
                                 [](const Mode&) {
                                   return Footprint{solver::PrimitiveType::plane, Axis::structure, true};
                                 },
                             .place =
                                 [](const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
                                   place_keep(mode, place, keep_out_mode.margin_side, primitives);
                                 }};

}  // namespace palpate::modes
