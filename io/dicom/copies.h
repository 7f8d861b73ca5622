#pragma once

/// Copies of the same image.

#include <vector>

#include "io/dicom/file_header.h"
#include "io/series.h"

namespace palpate::io::internal {

/// Drops an image that another file also holds: the same SOP instance UID, place and time. A readable copy is kept. If
/// both are readable and their pixels differ, the one that is kept gets a remark. Files with the same SOP instance UID
/// at different places are different images: both are kept, with a remark.
std::vector<FileHeader> drop_copies(std::vector<FileHeader> files, std::vector<SkippedFile>& skipped);

}  // namespace palpate::io::internal
