#pragma once

/// Groups files into series by their headers.

#include <string>
#include <vector>

#include "io/dicom/file_header.h"
#include "io/series.h"

namespace palpate::io::internal {

/// Groups the images of all files by series UID (of one study and patient), orientation, size and pixel spacing, sorts
/// them by position, and describes the series. `skipped` gets the files that belong to no series.
std::vector<Series> group_into_series(std::vector<FileHeader> headers, std::vector<SkippedFile>& skipped);

/// "axial", "coronal", "sagittal" (within 20 degrees) or "oblique".
std::string orientation_of(const Geometry& geometry);

}  // namespace palpate::io::internal
