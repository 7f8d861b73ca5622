#pragma once

/// Whether a scene can be felt on a scan at all.

#include <string>

#include "io/volume.h"
#include "modes/scene/scene.h"
#include "solver/text/message.h"

namespace palpate::plugin {

/// Why nothing of the scene can be felt on this scan: every mode that is switched on reads a field that the scan does
/// not have. Empty if something can be felt, or if no mode is switched on.
Text why_not_felt(const modes::Scene& scene, const io::Volume& volume);

}  // namespace palpate::plugin
