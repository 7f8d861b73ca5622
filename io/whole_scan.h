#pragma once

#include <filesystem>

namespace palpate::io {

/// Whether a file holds scans by itself: NIfTI, NRRD and MetaImage, by their names, and packed studies, by their first
/// bytes. A DICOM file, also a gzipped one, is a part of a series that lies in its folder. False where it is no file.
bool holds_whole_scans(const std::filesystem::path& file);

}  // namespace palpate::io
