// Landmark mode, equations (3) to (6): a point, line or plane that the user has set, at its own place in the patient; a
// plane pushes to its direction's side. Not co-located: alone it is analytical, with any other constraint it is a case
// for the general solver. Felt outside the data too, where only a constant strength is other than that of the value 0.
#include "modes/types/mode_type.h"

namespace palpate::modes {
namespace {

solver::PrimitiveType primitive_of(Shape shape) {
  switch (shape) {
    case Shape::point:
      return solver::PrimitiveType::point;
    case Shape::line:
      return solver::PrimitiveType::line;
    case Shape::plane:
      return solver::PrimitiveType::plane;
  }
  return solver::PrimitiveType::point;
}

}  // namespace

extern const ModeType landmark_mode;
const ModeType landmark_mode{.name = "landmark",
                             .summary = "a point, line or plane of the user's own, at its own place",
                             .keys = Key::strength | Key::gates | Key::landmark,
                             .strength_of = Datum::value,
                             .finds_places = false,
                             .reads = [](const Mode&) { return io::FieldSet::none; },
                             .footprint =
                                 [](const Mode& mode) {
                                   return Footprint{primitive_of(mode.shape), Axis::own, false};
                                 },
                             .place =
                                 [](const ActiveMode& mode, const Place& place, PrimitiveList& primitives) noexcept {
                                   primitives.add({.type = primitive_of(mode.shape),
                                                   .strength = mode.strength(place.sample),
                                                   .position = place.workspace.to_device(mode.position_mm),
                                                   .direction = place.workspace.direction_to_device(mode.direction)});
                                 }};

}  // namespace palpate::modes
