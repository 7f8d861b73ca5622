#pragma once

/// Presents a file that is not DICOM as a series.

#include "io/interchange/voxel_file.h"
#include "io/load.h"
#include "io/series.h"

namespace palpate::io {

/// One series with as many frames as the file has volumes. Its UID is computed from the file's first bytes, so that it
/// does not depend on the file's place. Its description is the file's name. `path`: the path that the user knows.
/// `keeper`: keeps a temporary file alive, or null.
Series series_of(VoxelFile file, const std::filesystem::path& path, std::shared_ptr<const void> keeper = nullptr);

/// As load(): voxels of up to 16 bits as stored values, others as rescaled floats, in which NaN is padding. Throws as
/// load() does.
Volume load_voxels(const VoxelFile& file, const std::string& name, const LoadOptions& options);

}  // namespace palpate::io
