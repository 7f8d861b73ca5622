#pragma once

#include <string>

#include "device/stylus.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recording.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {

/// The header of a recording: this version, the scene, the stylus, the scan by its hash, and the seed of the simulated
/// hand's tremor.
RecordingHeader header_for(const modes::Scene& scene, const device::Specification& stylus, const std::string& scan_hash,
                           double seed = 0);

/// The record of the first scene that is felt on a scan. Paths of files are left out. A felt structure is named by the
/// content that was read, even if its file was rewritten since.
SceneRecord record_of(const modes::Scene& scene, const PreparedScene& felt, const device::Specification& stylus,
                      const std::string& scan_hash);

}  // namespace palpate::plugin
