#pragma once

/// Series of which an anonymizer changed, or took away, what holds their files together.

#include <vector>

#include "io/dicom/file_header.h"

namespace palpate::io::internal {

/// Whether two images lie alike. Cosines of one series may differ in their last digits from file to file.
bool are_parallel(const Placement& a, const Placement& b);

/// Gives files of one series the study, the frame of reference and the patient that the others of it have: where each
/// file names one of its own although their places make up a stack, and where the patient's id is blank in some.
void join_torn_series(std::vector<FileHeader>& headers);

}  // namespace palpate::io::internal
