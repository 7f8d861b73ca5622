#pragma once

/// A volume in a file that is no DICOM, as a series.

#include "io/interchange/voxel_file.h"
#include "io/load.h"
#include "io/series.h"

namespace palpate::io {

/// One series with as many frames as the file has volumes. Its UID is made of the file's first bytes, so that it is the
/// same wherever the file lies; its description is the file's name. `path` is as its user knows it;
/// `keeper` is what keeps the file where it is, or null.
Series series_of(VoxelFile file, const std::filesystem::path& path, std::shared_ptr<const void> keeper = nullptr);

/// What load() gives of it: voxels of up to 16 bits as they are stored, others as rescaled floats, in which what is no
/// number is padding. Throws as load().
Volume load_voxels(const VoxelFile& file, const std::string& name, const LoadOptions& options);

}  // namespace palpate::io
