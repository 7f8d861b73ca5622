#pragma once

/// The same image sent twice.

#include <vector>

#include "io/dicom/file_header.h"
#include "io/series.h"

namespace palpate::io::internal {

/// Drops an image that another file holds, too: the same SOP instance, place and time. The readable one is kept; where
/// both are readable and their pixels differ, the kept one gets a remark. Files of one SOP instance UID at different
/// places are different images, whatever their UID says: both are kept, with a remark.
std::vector<FileHeader> drop_copies(std::vector<FileHeader> files, std::vector<SkippedFile>& skipped);

}  // namespace palpate::io::internal
