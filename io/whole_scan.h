#pragma once

#include <filesystem>

namespace palpate::io {

/// Whether a file holds whole scans: NIfTI, NRRD and MetaImage, by their names, and packed studies, by their first
/// bytes. Not a DICOM file, gzipped or not: it is part of a series in its folder. False if the path is not a file.
bool holds_whole_scans(const std::filesystem::path& file);

}  // namespace palpate::io
