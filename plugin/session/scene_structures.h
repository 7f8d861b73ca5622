#pragma once

/// The structures of a scene on a scan. They are read when the scene's plan needs them, and kept as long as it does.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/volume.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/session/registered_structure.h"
#include "solver/text/message.h"

namespace palpate::plugin {

/// A structure's distance on a scan, and what it was made of.
struct LoadedStructure {
  std::string file;            ///< as the scene names it, with its folder
  std::string segment;         ///< its name or number
  std::vector<Text> warnings;  ///< of how it lies on the scan
  std::optional<RegisteredStructure> registered;
  std::shared_ptr<const io::DistanceField> distance;
};

/// The structures that the plan reads, in its order. Reuses those in `before` that are still the same. Throws
/// std::invalid_argument that names the structure, if it has no such file or segment, is empty, is of another patient,
/// or lies in another frame of reference than the scan and no registration beside it joins the two. Those in `recorded`
/// are put where they were then; no registration is looked for.
std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const io::Volume& volume, const std::vector<LoadedStructure>& before,
                                             std::span<const RegisteredStructure> recorded = {});

}  // namespace palpate::plugin
