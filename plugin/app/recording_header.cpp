#include "plugin/app/recording_header.h"

#include "modes/scene/scene_json.h"
#include "plugin/structures/structure_files.h"

namespace palpate::plugin {
namespace {

/// The scene with the hash of what was read in place of the file of each felt structure.
modes::Scene with_hashes(modes::Scene scene, const PreparedScene& felt) {
  for (std::size_t n = 0; n < felt.structures.size(); ++n) {
    const std::string& hash = felt.structures[n].hash;
    if (!hash.empty()) scene.structures[felt.plan->structures[n]].file = hash;
  }
  return scene;
}

}  // namespace

RecordingHeader header_for(const modes::Scene& scene, const device::Specification& stylus, const std::string& scan_hash,
                           double seed) {
  return {.palpate_version = PALPATE_VERSION,
          .scene = modes::to_json(without_paths(scene)),
          .device = stylus.name,
          .scan_hash = scan_hash,
          .seed = seed,
          .rate_hz = stylus.rate};
}

SceneRecord record_of(const modes::Scene& scene, const PreparedScene& felt, const device::Specification& stylus,
                      const std::string& scan_hash) {
  SceneRecord record{.scene = modes::to_json(without_paths(with_hashes(scene, felt))),
                     .scan_hash = scan_hash,
                     .half_extent_m = stylus.workspace_half_extent,
                     .maximum_force_n = stylus.maximum_force,
                     .registered = registered_of(felt)};
  for (const std::size_t n : felt.plan->structures) record.structures.push_back(scene.structures[n].name);
  return record;
}

}  // namespace palpate::plugin
