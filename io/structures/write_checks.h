#pragma once

/// Checks that all writers of structures share.

#include <filesystem>
#include <utility>

#include "io/structures/label_image.h"
#include "io/whole_file.h"

namespace palpate::io {

inline Existing existing(const WriteOptions& options) {
  return options.overwrite ? Existing::replace : Existing::keep;
}

/// Throws DicomError if the file is the one that was corrected. Throws as check_may_write() does.
void check_target(const StructureLabel& label, const std::filesystem::path& file, const WriteOptions& options);

/// The first and the last slice with a voxel inside. Throws DicomError if there is none.
std::pair<int, int> occupied_slices(const LabelImage& image);

}  // namespace palpate::io
