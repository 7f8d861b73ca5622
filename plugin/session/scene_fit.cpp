#include "plugin/session/scene_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/fields/volume_fields.h"
#include "modes/scene/plan.h"
#include "modes/scene/strength.h"
#include "modes/types/mode_type.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

io::FieldSet fields_read_by(const modes::Mode& mode) {
  io::FieldSet reads = modes::find_mode_type(mode.type)->reads(mode) | modes::field_of(mode.strength_of);
  for (const modes::Gate& gate : mode.gates) reads = reads | modes::field_of(gate.of);
  return reads;
}

io::FieldSet without(io::FieldSet set, io::FieldSet taken) {
  return static_cast<io::FieldSet>(static_cast<unsigned>(set) & ~static_cast<unsigned>(taken));
}

}  // namespace

Text why_not_felt(const modes::Scene& scene, const io::Volume& volume) {
  // Distances are of the scene's own structures, whatever the scan.
  const io::FieldSet available = io::fields_of(volume) | io::FieldSet::distance;
  io::FieldSet missing = io::FieldSet::none;
  for (const modes::Mode& mode : scene.modes) {
    if (!mode.enabled || !modes::find_mode_type(mode.type)) continue;
    const io::FieldSet lacks = without(fields_read_by(mode), available);
    if (lacks == io::FieldSet::none) return {};
    missing = missing | lacks;
  }
  if (missing == io::FieldSet::none) return {};
  const std::string name = scene.name.empty() ? "this scene" : "the scene \"" + scene.name + "\"";
  return say("cannot-be-felt-on-this-scan", name, fmt::format("{}", fmt::join(modes::names_of(missing), ", ")));
}

}  // namespace palpate::plugin
