#pragma once

/// The structures of a scene on a scan: read when the scene's plan needs them, and kept as long as it does.

#include <memory>
#include <string>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/volume.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"

namespace palpate::plugin {

/// A structure's distance on a scan, and what it was made of.
struct LoadedStructure {
  std::string file;     ///< as the scene names it, with its folder
  std::string segment;  ///< its name or number
  std::shared_ptr<const io::DistanceField> distance;
};

/// Those that the plan reads, in its order; of `before` those that are the same still. Throws std::invalid_argument
/// that names the structure: no such file or segment, in another frame of reference than the scan, empty.
std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const io::Volume& volume, const std::vector<LoadedStructure>& before);

}  // namespace palpate::plugin
