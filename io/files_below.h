#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "io/progress.h"
#include "io/series.h"

namespace palpate::io::internal {

/// All files in these paths and in the folders below them, in order, each once. A DICOMDIR stands for its folder. A
/// subfolder that cannot be read is added to `skipped`. Calls `progress` with 0 for each entry of a folder.
/// Throws DicomError if a path does not exist or cannot be listed, and Cancelled.
std::vector<std::filesystem::path> files_below(std::span<const std::filesystem::path> paths,
                                               std::vector<SkippedFile>& skipped, const Progress& progress = {});

}  // namespace palpate::io::internal
