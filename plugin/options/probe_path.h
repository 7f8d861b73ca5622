#pragma once

/// Where a simulated hand goes: --path, or a press on the first boundary between --from and --to.

#include <filesystem>
#include <string>

#include "io/volume.h"
#include "modes/scene/scene.h"
#include "plugin/session/prepared_scene.h"

namespace CLI {
class App;
}
namespace palpate::device {
class SimulatedStylus;
}

namespace palpate::plugin {

struct ProbePathOption {
  std::filesystem::path file;
  std::string from, to;  ///< "x,y,z" in mm; empty: from the front towards the middle, at 3/4 of the scan's height
};

/// `option` has to live as long as the command.
void add_probe_path_option(CLI::App& command, ProbePathOption& option);

/// Makes the hand follow the path, and returns its end, s. If the scene names no center of the workspace, it gets the
/// path's middle, in the scene and in the plan. Throws InputRefused if the path leaves the workspace, and what reading
/// the path or feeling the way throws.
double follow_probe_path(const ProbePathOption& option, const io::Volume& volume, modes::Scene& scene,
                         PreparedScene& felt, device::SimulatedStylus& stylus);

}  // namespace palpate::plugin
