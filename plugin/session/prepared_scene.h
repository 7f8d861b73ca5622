#pragma once

/// A scene prepared for a scan: its plan, and the fields and structures that the plan reads.

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

/// The fields that a plan reads from the scan itself: all but the distances from structures.
io::FieldSet scan_fields(const modes::Plan& plan) noexcept;

/// A scene on a scan: the plan, and exactly the fields that this plan needs.
struct PreparedScene {
  std::shared_ptr<const modes::Plan> plan;
  std::shared_ptr<const io::FieldSource> source;
  std::shared_ptr<const io::Volume> volume;  ///< the scan after the scene's filter
  std::vector<LoadedStructure> structures;   ///< those that the plan reads, in its order
};
/// Structures in `recorded` are placed as they were recorded.
PreparedScene prepare(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                      const glm::dvec3& device_half_extent_m, std::span<const RegisteredStructure> recorded = {});

/// An earlier preparation. `felt.volume` alone may be given too: a volume that was filtered ahead.
struct Prepared {
  PreparedScene felt;
  modes::Scene scene;
  std::vector<LoadedStructure> read_ahead{};  ///< structures on the scan for a later scene: not read again
};
/// The same, but reuses parts of `felt`: the filtered volume and the fields, if the scene still needs exactly these and
/// the scan is the same; and the structures, also if the scan is another frame of the series. So a scene that is being
/// edited, and the next frame, are ready at once.
PreparedScene prepare(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                      const glm::dvec3& device_half_extent_m, const Prepared& before,
                      std::span<const RegisteredStructure> recorded = {});
/// The structures that a registration placed on the scan.
std::vector<RegisteredStructure> registered_of(const PreparedScene& felt);

}  // namespace palpate::plugin
