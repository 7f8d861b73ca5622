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
#include "plugin/structures/registered_structure.h"
#include "solver/text/message.h"

namespace palpate::plugin {

/// A structure's distance on a scan, and what it was made of.
struct LoadedStructure {
  std::string file;            ///< as the scene names it, with its folder; empty if the scene's contours make it
  std::string segment;         ///< its name or number
  std::vector<Text> warnings;  ///< of how it lies on the scan
  std::optional<RegisteredStructure> registered;
  std::shared_ptr<const io::DistanceField> distance;
  std::vector<io::Edit> edits{};  ///< of its outline, which `distance` has
  /// The field before the first edit (null if contours make it), and after each but the last: to undo an edit is to
  /// take one of them.
  std::vector<std::shared_ptr<const io::DistanceField>> before_edits{};
};

/// The structures that the plan reads, in its order. Reuses those in `before` that are still the same, and the fields
/// of the edits that both begin with. Throws std::invalid_argument that names the structure, if it has no such file or
/// segment, is empty, is of another patient, an edit of it cannot be done, or it lies in another frame of reference
/// than the scan and no registration beside it joins the two. Those in `recorded` are put where they were then; no
/// registration is looked for. Fields of edits are shared (shared_edits.h); those that read the scan only where it is
/// owned.
std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const io::Volume& volume, const std::vector<LoadedStructure>& before,
                                             std::span<const RegisteredStructure> recorded = {});
std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const std::shared_ptr<const io::Volume>& scan,
                                             const std::vector<LoadedStructure>& before,
                                             std::span<const RegisteredStructure> recorded = {});

/// Those of another frame of the scan's series, or of the same scan in other values: without the fields of edits that
/// read the scan. None if the two do not lie alike, or are not of one patient.
std::vector<LoadedStructure> carried_over(const std::vector<LoadedStructure>& structures, const io::Volume& from,
                                          const io::Volume& to);

/// Whether load_structures() finds all that the plan reads among these: it then reads no file and computes no field.
bool are_loaded(const modes::Scene& scene, const modes::Plan& plan, const std::vector<LoadedStructure>& before);

}  // namespace palpate::plugin
