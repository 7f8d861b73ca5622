#pragma once

/// Keeps the files that a command writes apart from those that it reads.

#include <filesystem>
#include <vector>

#include "io/series.h"
#include "modes/scene/scene.h"

namespace palpate::plugin {

/// Throws InputRefused if an output is the same file as an input or as another output, also by a link or another path.
/// Empty paths stand for none; an input may be a folder, or not exist.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

/// The files of a series, and then the files of a scene's structures, for check_outputs().
std::vector<std::filesystem::path> files_read(const io::Series& series, const modes::Scene& scene = {});

}  // namespace palpate::plugin
