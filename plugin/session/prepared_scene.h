#pragma once

/// A scene made ready on a scan: its plan, and the fields and structures that the plan reads.

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "io/fields/field_source.h"
#include "io/volume.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/structures/scene_structures.h"

namespace palpate::plugin {

/// The plan of a scene on a scan with the fields that this scan has (vectors if it is a velocity field), for a device
/// with this reach.
std::shared_ptr<const modes::Plan> plan_for(const modes::Scene& scene, const io::Volume& volume,
                                            const glm::dvec3& device_half_extent_m);

/// What a plan reads of the scan itself: all but the distances from structures.
io::FieldSet scan_fields(const modes::Plan& plan) noexcept;

/// A scene on a scan: the plan, and exactly the fields that this plan needs.
struct PreparedScene {
  std::shared_ptr<const modes::Plan> plan;
  std::shared_ptr<const io::FieldSource> source;
  std::shared_ptr<const io::Volume> volume;  ///< the scan as it is felt: through the scene's filter
  std::vector<LoadedStructure> structures;   ///< those that the plan reads, in its order
};
/// Structures in `recorded` are put where they were then.
PreparedScene prepare(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                      const glm::dvec3& device_half_extent_m, std::span<const RegisteredStructure> recorded = {});

/// What was prepared before. `felt.volume` alone may be given too: a volume that was filtered ahead.
struct Prepared {
  PreparedScene felt;
  modes::Scene scene;
  std::vector<LoadedStructure> read_ahead{};  ///< of the scan, for a scene that comes: not read again
};
/// The same, but takes the filtered volume and the fields from `felt` if the scene still needs exactly these of this
/// scan, and its structures on another frame of the series, too. So a scene that is being edited, and the next frame,
/// are ready at once.
PreparedScene prepare(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                      const glm::dvec3& device_half_extent_m, const Prepared& before,
                      std::span<const RegisteredStructure> recorded = {});
/// Those of its structures that a registration put on the scan.
std::vector<RegisteredStructure> registered_of(const PreparedScene& felt);

}  // namespace palpate::plugin
