#pragma once

/// Opens a series as a scan with its first scene, in the same way for command line, panel and server, and for scans
/// from a folder, an archive or a server.

#include <string>

#include "io/progress.h"
#include "io/series.h"
#include "io/volume.h"
#include "modes/scene/scene.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {

/// One frame of a series, its values rescaled. Warnings go to stderr, and progress if stderr is a terminal.
io::Volume open_scan(const io::Series& series, int frame);
/// The same with another progress. Throws io::Cancelled.
io::Volume open_scan(const io::Series& series, int frame, const io::Progress& progress);

/// The scene of that name: a file or a starting scene. If the name is empty: the one that suits the scan
/// (modes::starting_scene). Throws std::invalid_argument as modes::load_scene() does.
modes::Scene scene_for(const std::string& file_or_name, const io::Volume& volume);

/// The scan in words, for reports: "CT, 256 x 256 x 108 voxels of 0.957 x 0.957 x 1.5 mm". Names no patient and no
/// path.
std::string describe_scan(const io::Volume& volume);

/// Prints warnings on stderr about the positions of the scene's structures on the scan.
void warn_of_structures(const PreparedScene& felt);

/// A progress line on stderr, with `what` before the percentage; an empty one if stderr is no terminal.
io::Progress terminal_progress(std::string what);

}  // namespace palpate::plugin
