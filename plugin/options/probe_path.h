#pragma once

/// The path of a simulated hand: --path, or a press on the first boundary between --from and --to.

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

/// `option` must outlive the command.
void add_probe_path_option(CLI::App& command, ProbePathOption& option);

/// Makes the hand follow the path, and returns the path's end, s. If the scene names no center of the workspace, the
/// middle of the path becomes the center, in the scene and in the plan. Throws InputRefused if the path leaves the
/// workspace, and errors of reading the path or of the search for the boundary.
double follow_probe_path(const ProbePathOption& option, const io::Volume& volume, modes::Scene& scene,
                         PreparedScene& felt, device::SimulatedStylus& stylus);

}  // namespace palpate::plugin
