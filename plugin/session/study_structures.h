#pragma once

/// Structures of a study: which of those that were found can be felt on a scan, and how they come into a scene.

#include <string>

#include "io/structures/structure.h"
#include "io/volume.h"
#include "modes/scene/scene.h"

namespace palpate::plugin {

/// Why it cannot be felt on this scan, and what to do; empty where it can.
Text why_not_on(const io::Structure& structure, const io::Volume& scan);

/// Whether that is what the scene's structure means.
bool is_same(const modes::SceneStructure& named, const io::Structure& structure);

/// Its name in the scene, where it is added if it is not there yet; with a number behind it where the scene has another
/// one of that name.
std::string name_in_scene(modes::Scene& scene, const io::Structure& structure);

/// A surface at its edge, resisted on the way in.
void add_boundary_of(modes::Scene& scene, const io::Structure& structure);
/// A margin that is kept out of, and told of.
void add_keep_out_of(modes::Scene& scene, const io::Structure& structure, double margin_mm);
/// Lets a mode of the scene act inside it only.
void add_gate_of(modes::Scene& scene, std::size_t mode, const io::Structure& structure);

}  // namespace palpate::plugin
