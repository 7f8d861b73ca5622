#pragma once

#include <string>

#include "device/stylus.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recording.h"

namespace palpate::plugin {

/// What a recording says of itself: this version, the scene, the stylus, the scan by its hash, and the seed of a
/// simulated hand's tremor.
RecordingHeader header_for(const modes::Scene& scene, const device::Specification& stylus, const std::string& scan_hash,
                           double seed = 0);

/// What a recording says of a scene that is felt on a scan, of its first epoch. No path is in it.
SceneRecord record_of(const modes::Scene& scene, const modes::Plan& plan, const device::Specification& stylus,
                      const std::string& scan_hash);

}  // namespace palpate::plugin
