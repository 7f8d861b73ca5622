#pragma once

/// Series whose files an anonymizer has separated by changing or removing their common identifiers.

#include <vector>

#include "io/dicom/file_header.h"

namespace palpate::io::internal {

/// Whether two images have the same orientation. Cosines of one series may differ in their last digits between files.
bool are_parallel(const Placement& a, const Placement& b);

/// Repairs files of one series: sets the same study and frame of reference if each file has its own although the
/// positions form one stack, and fills in the patient id of the others where it is blank.
void join_torn_series(std::vector<FileHeader>& headers);

}  // namespace palpate::io::internal
