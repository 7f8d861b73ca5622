#pragma once

/// A session as pictures: where it was, what was felt, how long a tick took.

#include <filesystem>
#include <vector>

#include "io/fields/field_source.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recording.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {

/// Writes slice.png, force-depth.png, force-time.png and tick-time.png into the folder; returns their names. `unit` is
/// the scan's. Throws std::runtime_error naming the file.
std::vector<std::string> write_session_pictures(const Recording& recording, const Summary& summary,
                                                const modes::Scene& scene, const modes::Plan& plan,
                                                const io::FieldSource& source, const std::string& unit,
                                                const std::filesystem::path& folder);

}  // namespace palpate::plugin
