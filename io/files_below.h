#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "io/series.h"

namespace palpate::io::internal {

/// All files in these files and folders, searched to the bottom, in order and each once; a DICOMDIR stands for its
/// folder. Folders below that may not be read are added to
/// `skipped`. Throws DicomError if a path does not exist or cannot be listed.
std::vector<std::filesystem::path> files_below(std::span<const std::filesystem::path> paths,
                                               std::vector<SkippedFile>& skipped);

}  // namespace palpate::io::internal
