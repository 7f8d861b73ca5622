#pragma once

/// Images that are present more than once.

#include <vector>

#include "io/dicom/file_header.h"
#include "io/series.h"

namespace palpate::io::internal {

/// Drops copies of an image: files with the same SOP instance UID, position and time. A readable copy is kept. If both
/// are readable and their pixels differ, the kept one gets a remark. Files with one SOP instance UID at different
/// positions are different images: both are kept, with a remark.
std::vector<FileHeader> drop_copies(std::vector<FileHeader> files, std::vector<SkippedFile>& skipped);

}  // namespace palpate::io::internal
