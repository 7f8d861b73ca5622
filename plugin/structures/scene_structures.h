#pragma once

/// The structures of a scene on a scan. They are read when the scene's plan needs them, and kept while it needs them.

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

/// A structure's distance on a scan, and its sources.
struct LoadedStructure {
  std::string file;            ///< as the scene names it, with its folder; empty for contours of the scene
  std::string hash;            ///< of the file's content as it was read (hash_of_file()); empty for contours
  std::string segment;         ///< its name or number
  std::vector<Text> warnings;  ///< about its position on the scan
  std::optional<RegisteredStructure> registered;
  std::shared_ptr<const io::DistanceField> distance;
  std::vector<io::Edit> edits{};  ///< the edits of its outline that `distance` includes
  /// The field before the first edit (null for contours), and after each edit except the last: an edit is undone by
  /// taking one of them.
  std::vector<std::shared_ptr<const io::DistanceField>> before_edits{};
};

/// The structures that the plan reads, in its order. Reuses unchanged structures in `before`, and the fields of the
/// first edits of a structure as far as both lists of edits are the same; also if their files were rewritten since or
/// are gone. Throws std::invalid_argument naming the structure if its file or segment does not exist, if it is empty or
/// belongs to another patient, if an edit of it is impossible, or if it has another frame of reference than the scan
/// and no registration beside it joins the two. Structures in `recorded` are placed as they were when recorded, without
/// searching for registrations. Fields of edits are shared (shared_edits.h). Those of edits that read the scan are
/// shared only if the scan has an owner.
std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const io::Volume& volume, const std::vector<LoadedStructure>& before,
                                             std::span<const RegisteredStructure> recorded = {});
std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const std::shared_ptr<const io::Volume>& scan,
                                             const std::vector<LoadedStructure>& before,
                                             std::span<const RegisteredStructure> recorded = {});

/// The structures for another frame of the scan's series, or for the same scan with other values: without the fields of
/// edits that read the scan. None if the two differ in geometry or patient.
std::vector<LoadedStructure> carried_over(const std::vector<LoadedStructure>& structures, const io::Volume& from,
                                          const io::Volume& to);

/// Whether all structures of the plan are in `before`: then load_structures() reads no file and computes no field.
bool are_loaded(const modes::Scene& scene, const modes::Plan& plan, const std::vector<LoadedStructure>& before);

}  // namespace palpate::plugin
